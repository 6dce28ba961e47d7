/// The principal moments and axes of an inertia matrix.
#include <array>
#include <cstddef>
#include <utility>

#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

/// A symmetric matrix during diagonalisation, and the accumulated rotation (columns: axes).
struct Jacobi {
    std::array<std::array<double, 3>, 3> a;
    std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    /// Rotates in the plane of axes p and q, by at most 45°, so that a[p][q] becomes 0.
    void rotate(std::size_t p, std::size_t q) {
        if (a[p][q] == 0) return;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double root = std::sqrt(theta * theta + 1);
        const double t = theta >= 0 ? 1 / (theta + root) : -1 / (root - theta);
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const std::size_t r = 3 - p - q;
        a[p][p] -= t * a[p][q];
        a[q][q] += t * a[p][q];
        a[p][q] = a[q][p] = 0;
        const double rp = a[r][p], rq = a[r][q];
        a[r][p] = a[p][r] = c * rp - s * rq;
        a[r][q] = a[q][r] = s * rp + c * rq;
        for (auto& row : v) row = rotated(row, p, q, c, s);
    }
    static std::array<double, 3> rotated(std::array<double, 3> row, std::size_t p, std::size_t q, double c, double s) {
        const double vp = row[p], vq = row[q];
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
        return row;
    }
    [[nodiscard]] double off_diagonal() const { return a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2]; }
};

}  // namespace

PrincipalInertia principal(const Mat3& inertia) {
    const Mat3d m = to_double(inertia);
    const double xy = (m.x.y + m.y.x) / 2, xz = (m.x.z + m.z.x) / 2, yz = (m.y.z + m.z.y) / 2;
    Jacobi j{{{{m.x.x, xy, xz}, {xy, m.y.y, yz}, {xz, yz, m.z.z}}}};
    // Convergence is quadratic: 5 or 6 sweeps reach 0; the bound ends the loop on NaN only.
    for (int sweep = 0; sweep < 20 && j.off_diagonal() != 0; ++sweep) {
        j.rotate(0, 1);
        j.rotate(0, 2);
        j.rotate(1, 2);
    }
    // Of the 24 permutations and signs of the axes that are right-handed, the one with the largest trace has the
    // smallest rotation angle.
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    Mat3d best;
    Vec3d moments;
    double best_trace = -4;
    for (std::size_t o = 0; o < orders.size(); ++o) {
        const auto [x, y, z] = orders[o];
        for (const auto& [sx, sy] : {std::pair{1.0, 1.0}, {1.0, -1.0}, {-1.0, 1.0}, {-1.0, -1.0}}) {
            const double sz = (o < 3 ? 1.0 : -1.0) * sx * sy;  // the last three orders mirror
            const double trace = sx * j.v[0][x] + sy * j.v[1][y] + sz * j.v[2][z];
            if (!(trace > best_trace)) continue;
            best_trace = trace;
            best = {Vec3d{j.v[0][x], j.v[1][x], j.v[2][x]} * sx, Vec3d{j.v[0][y], j.v[1][y], j.v[2][y]} * sy,
                    Vec3d{j.v[0][z], j.v[1][z], j.v[2][z]} * sz};
            moments = {j.a[x][x], j.a[y][y], j.a[z][z]};
        }
    }
    return {to_float(moments), to_float(to_quat(best))};
}

}  // namespace fase
