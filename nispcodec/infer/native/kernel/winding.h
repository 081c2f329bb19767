// How often solid triangles go round a point, clusters that are far taken as one (Barill et al. 2018).
#pragma once

#include "tree.h"

namespace nisp {

class Winding {
   public:
    Winding(const Tree& tree, const double* point)
        : tree_(tree), point_{WideDoubles{} + point[0], WideDoubles{} + point[1], WideDoubles{} + point[2]} {}

    // The winding number, each cluster as one from `radii` of its radii away.
    double about(double radii) {
        squared_radii_ = static_cast<float>(radii * radii);
        Floats angles = {};
        stack_[waiting_++] = {0, 0};
        while (waiting_ > 0) {
            const Place next = stack_[--waiting_];
            for (int first = 0; first < LANES; first += FLOATS)
                angles += next.level < tree_.levels ? look_into(next, first) : solid_angles(next.index, first);
        }
        return sum(angles) / (4 * M_PI);
    }

   private:
    const Tree& tree_;
    const Three<WideDoubles> point_;
    float squared_radii_ = 0;
    int waiting_ = 0;
    Place stack_[MOST_WAITING + 1];

    // The solid angles of those of FLOATS children that are far; the others wait. Without branches, as
    // no processor foretells which they are.
    Floats look_into(Place node, int first) {
        const float* rows = tree_.clusters[node.level] + int64_t(node.index) * CLUSTER_ROWS * LANES + first;
        const Three<Floats> point = {rounded(point_.x), rounded(point_.y), rounded(point_.z)};
        const auto way = load_three<Floats>(rows) - point;
        const Floats squared = way.dot(way);
        const auto far = squared > load<Floats>(rows + 3 * LANES) * squared_radii_;
        int32_t is_far[FLOATS];
        store(is_far, far);
        int top = waiting_;
        for (int lane = 0; lane < FLOATS; lane++) {
            stack_[top] = node.child(first + lane);
            top += is_far[lane] == 0;
        }
        waiting_ = top;
        return far ? far_angles(rows, way, squared) : Floats{};
    }

    // As `far_angles` of multipoles.py.
    static Floats far_angles(const float* rows, const Three<Floats>& way, Floats squared) {
        const Floats inverse = 1.0f / greatest(squared, Floats{} + 1e-30f);
        const Floats dipole = way.dot(load_three<Floats>(rows + 4 * LANES));
        const Three<Floats> squares = {way.x * way.x, way.y * way.y, way.z * way.z};
        const Three<Floats> products = {way.x * way.y, way.y * way.z, way.z * way.x};
        const Floats quadrupole = squares.dot(load_three<Floats>(rows + 7 * LANES)) +
                                  products.dot(load_three<Floats>(rows + 10 * LANES)) * 2.0f;
        return (dipole + quadrupole * inverse) * inverse * square_root(inverse);
    }

    // As `solid_angles` of triangles.py. Ways are taken in double precision: near a triangle it is
    // their differences that count.
    Floats solid_angles(int32_t leaf, int first) const {
        const double* rows = tree_.triangles + int64_t(leaf) * TRIANGLE_ROWS * LANES + first;
        const auto a = way_to(rows), b = way_to(rows + 3 * LANES), c = way_to(rows + 6 * LANES);
        const Floats volume = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
        const Floats la = square_root(a.dot(a)), lb = square_root(b.dot(b)), lc = square_root(c.dot(c));
        const Floats rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        return arc(volume, rest) * load<Floats>(tree_.solid + int64_t(leaf) * LANES + first) * 2.0f;
    }

    Three<Floats> way_to(const double* rows) const {
        const auto way = load_three<WideDoubles>(rows) - point_;
        return {rounded(way.x), rounded(way.y), rounded(way.z)};
    }

    // The angle of (x, y), as atan2; 0 where y is. Polynomial of Abramowitz and Stegun, 4.4.47 to
    // its form: within 1e-5.
    static Floats arc(Floats y, Floats x) {
        const Floats none = {}, wide = x < none ? -x : x, high = y < none ? -y : y;
        const Floats t = least(wide, high) / greatest(greatest(wide, high), none + 1e-37f), s = t * t;
        Floats angle = t * (0.99997726f + s * (-0.33262347f + s * (0.19354346f + s * (-0.11643287f + s * (0.05265332f - s * 0.01172120f)))));
        angle = high > wide ? float(M_PI_2) - angle : angle;
        angle = x < none ? float(M_PI) - angle : angle;
        angle = y < none ? -angle : angle;
        return y == none ? none : angle;
    }
};

}  // namespace nisp
