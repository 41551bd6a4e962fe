function circle(rudder_deg, duration_s, step_s)
% A turning circle as CSV, by the classical Runge-Kutta method.
model = MODEL();
model.step_s = step_s;
x = model.x;
ui = model.ui;
ui(1) = rudder_deg*pi/180;
f = @(x) MODEL(x, ui, model);
printf("t_s,u_m_s,v_m_s,r_rad_s,p_rad_s,phi_rad,psi_rad,x_m,y_m,delta_rad\n");
for k = 0:round(duration_s/step_s)
    printf("%.17g", k*step_s);
    printf(",%.17g", x);
    printf("\n");
    k1 = f(x);
    k2 = f(x + 0.5*step_s*k1);
    k3 = f(x + 0.5*step_s*k2);
    k4 = f(x + step_s*k3);
    x = x + step_s/6*(k1 + 2*(k2 + k3) + k4);
end
end
