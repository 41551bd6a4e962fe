function [xdot, U, model, outside_range] = @@model(x, ui, model)
@@help
%
% model = @@model()                  the structure: coefficients, steering gear, approach
% [xdot, U] = @@model(x, ui)         rates of the states, and the speed
% [xdot, U] = @@model(x, ui, model)  the same with a changed structure
% [xdot, U, model, outside_range] = @@model(x, ui)  and how far this is outside of the trials
%
% x  = [u v r p phi psi x y delta]'
% ui = [@@order_of_inputs]'; model.ui holds those of the approach, model.x its state
if nargin < 3
    model = structure();
end
if nargin == 0
    xdot = model;
    U = [];
    outside_range = [];
    return
end
u = x(1); v = x(2); r = x(3); p = x(4); phi = x(5); psi = x(6); delta = x(9);
@@unpack
c = model.c;
xdot = zeros(9, 1);
@@statements
@@rudder
@@range
U = hypot(u, v);
end

function value = choice(condition, yes, no)
if condition
    value = yes;
else
    value = no;
end
end

function model = structure()
@@structure
end
