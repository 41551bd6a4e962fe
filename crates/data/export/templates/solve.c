/* Solves four equations with four unknowns: coefficients and right-hand sides in, solution out. */
static void solve(double m[4][5], double *a)
{
    for (int k = 0; k < 4; k++) {
        int best = k;
        for (int i = k + 1; i < 4; i++)
            if (fabs(m[i][k]) > fabs(m[best][k]))
                best = i;
        for (int j = 0; j < 5; j++) {
            const double kept = m[k][j];
            m[k][j] = m[best][j];
            m[best][j] = kept;
        }
        for (int i = k + 1; i < 4; i++) {
            const double factor = m[i][k]/m[k][k];
            for (int j = k; j < 5; j++)
                m[i][j] -= factor*m[k][j];
        }
    }
    for (int k = 3; k >= 0; k--) {
        a[k] = m[k][4];
        for (int j = k + 1; j < 4; j++)
            a[k] -= m[k][j]*a[j];
        a[k] /= m[k][k];
    }
}

