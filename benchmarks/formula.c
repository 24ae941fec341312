/* The textbook formula of speed_rivals.py over arrays, as one writes it in C. */
#include <math.h>

void formula(long count, const double *const *in, double *const *out)
{
    for (long k = 0; k < count; k++) {
        double m1 = in[0][k], i1 = in[1][k], vx1 = in[2][k], vy1 = in[3][k], w1 = in[4][k], x1 = in[5][k], y1 = in[6][k];
        double m2 = in[7][k], i2 = in[8][k], vx2 = in[9][k], vy2 = in[10][k], w2 = in[11][k], x2 = in[12][k], y2 = in[13][k];
        double e = in[14][k], nx = cos(in[15][k]), ny = sin(in[15][k]), px = in[16][k], py = in[17][k], friction = in[18][k];
        double rx1 = px - x1, ry1 = py - y1, rx2 = px - x2, ry2 = py - y2;
        double ux = (vx2 - w2 * ry2) - (vx1 - w1 * ry1), uy = (vy2 + w2 * rx2) - (vy1 + w1 * rx1);
        double un = ux * nx + uy * ny, ut = uy * nx - ux * ny;
        double rn1 = rx1 * nx + ry1 * ny, rt1 = ry1 * nx - rx1 * ny, rn2 = rx2 * nx + ry2 * ny, rt2 = ry2 * nx - rx2 * ny;
        double knn = 1 / m1 + 1 / m2 + rt1 * rt1 / i1 + rt2 * rt2 / i2;
        double ktt = 1 / m1 + 1 / m2 + rn1 * rn1 / i1 + rn2 * rn2 / i2;
        double knt = -(rn1 * rt1 / i1 + rn2 * rt2 / i2);
        double vn = -(1 + e) * un, det = knn * ktt - knt * knt;
        double pn = (ktt * vn + knt * ut) / det, pt = -(knt * vn + knn * ut) / det;
        if (pn <= 0 || fabs(pt) > friction * pn) {
            double mu = pt < 0 ? -friction : friction;
            pn = vn / (knn + mu * knt);
            pt = mu * pn;
        }
        double fx = pn * nx - pt * ny, fy = pn * ny + pt * nx;
        double ax1 = vx1 - fx / m1, ay1 = vy1 - fy / m1, aw1 = w1 - (rx1 * fy - ry1 * fx) / i1;
        double ax2 = vx2 + fx / m2, ay2 = vy2 + fy / m2, aw2 = w2 + (rx2 * fy - ry2 * fx) / i2;
        double before = m1 * (vx1 * vx1 + vy1 * vy1) + i1 * w1 * w1 + m2 * (vx2 * vx2 + vy2 * vy2) + i2 * w2 * w2;
        double after = m1 * (ax1 * ax1 + ay1 * ay1) + i1 * aw1 * aw1 + m2 * (ax2 * ax2 + ay2 * ay2) + i2 * aw2 * aw2;
        double found[9] = {ax1, ay1, aw1, ax2, ay2, aw2, pn, pt, (before - after) / 2};
        for (int i = 0; i < 9; i++)
            out[i][k] = un < 0 ? found[i] : NAN;
    }
}
