// The triangle that is closest to a point.
//
// The arithmetic is that of `nispcodec.infer.triangles`, operation by operation and without fused
// ones, so that distances are the same to the last bit.
#pragma once

#include <algorithm>

#include "tree.h"

namespace nisp {

struct Found {
    int32_t face;
    double squared;
};

class ClosestTriangle {
   public:
    ClosestTriangle(const Tree& tree, const double* point)
        : tree_(tree),
          point_{Doubles{} + point[0], Doubles{} + point[1], Doubles{} + point[2]},
          slack_(ROUNDING * (1 + std::max({std::fabs(point[0]), std::fabs(point[1]), std::fabs(point[2])}))) {}

    Found search() {
        look_into({0, 0});
        while (waiting_ > 0) {
            const Waiting next = stack_[--waiting_];
            if (next.bound >= reach_) continue;
            if (next.place.level < tree_.levels)
                look_into(next.place);
            else
                measure(next.place.index);
        }
        return found_;
    }

   private:
    // As `closest_triangle.py` has it.
    static constexpr double ROUNDING = 1e-14;
    struct Waiting {
        double bound;
        Place place;
    };

    const Tree& tree_;
    const Three<Doubles> point_;
    const double slack_;
    Found found_{INT32_MAX, INFINITY};
    double reach_ = INFINITY;  // found_.squared and what rounding may have taken
    int waiting_ = 0;
    Waiting stack_[MOST_WAITING + 1];

    // Lets its children wait whose boxes are in reach, the nearest on top. Without branches, as no
    // processor foretells which they are.
    void look_into(Place node) {
        const double* boxes = tree_.boxes[node.level] + int64_t(node.index) * BOX_ROWS * LANES;
        double bounds[LANES];
        for (int lane = 0; lane < LANES; lane += DOUBLES) store(bounds + lane, box_distances(boxes + lane));
        int top = waiting_, nearest = top;
        double least_bound = reach_;
        for (int child = 0; child < LANES; child++) {
            const double bound = bounds[child];
            stack_[top] = {bound, node.child(child)};
            nearest = bound < least_bound ? top : nearest;
            least_bound = std::min(bound, least_bound);
            top += bound < reach_;
        }
        if (top > waiting_) std::swap(stack_[nearest], stack_[top - 1]);
        waiting_ = top;
    }

    Doubles box_distances(const double* boxes) const {
        const auto low = load_three<Doubles>(boxes), high = load_three<Doubles>(boxes + 3 * LANES);
        const auto below = low - point_, above = point_ - high;
        const Three<Doubles> off = {outside(below.x, above.x), outside(below.y, above.y), outside(below.z, above.z)};
        return off.dot(off);
    }
    static Doubles outside(Doubles below, Doubles above) { return greatest(greatest(below, above), Doubles{}); }

    void measure(int32_t leaf) {
        const double* rows = tree_.triangles + int64_t(leaf) * TRIANGLE_ROWS * LANES;
        double squared[LANES];
        for (int lane = 0; lane < LANES; lane += DOUBLES) store(squared + lane, squared_distances(rows + lane));
        double nearest = squared[0];
        for (int lane = 1; lane < LANES; lane++) nearest = std::min(nearest, squared[lane]);
        if (nearest > found_.squared) return;
        const int32_t* faces = tree_.faces + int64_t(leaf) * LANES;
        for (int lane = 0; lane < LANES; lane++) {
            const bool nearer = squared[lane] < found_.squared;
            if (nearer || (squared[lane] == found_.squared && faces[lane] < found_.face))
                found_ = {faces[lane], squared[lane]};
        }
        const double wide = std::sqrt(found_.squared) + slack_;
        reach_ = wide * wide;
    }

    Doubles squared_distances(const double* rows) const {
        const auto a = load_three<Doubles>(rows) - point_, b = load_three<Doubles>(rows + 3 * LANES) - point_,
                   c = load_three<Doubles>(rows + 6 * LANES) - point_;
        const Doubles aa = a.dot(a), bb = b.dot(b), cc = c.dot(c);
        const double* inverse = rows + 9 * LANES;
        const Doubles edges = least(least(to_edge(a, b, aa, bb, load<Doubles>(inverse)),
                                          to_edge(b, c, bb, cc, load<Doubles>(inverse + LANES))),
                                    to_edge(c, a, cc, aa, load<Doubles>(inverse + 2 * LANES)));
        const Doubles v = -a.dot(load_three<Doubles>(rows + 12 * LANES)), w = -a.dot(load_three<Doubles>(rows + 15 * LANES));
        const auto off = a + (b - a) * v + (c - a) * w;
        const Doubles none = {}, inside = off.dot(off);
        const auto over = (v > none) & (w > none) & (v + w < none + 1.0);
        return over ? least(edges, inside) : edges;
    }

    // Of an edge whose ends are as far off the point as `start` and `end`.
    static Doubles to_edge(const Three<Doubles>& start, const Three<Doubles>& end, Doubles at_start, Doubles at_end,
                           Doubles inverse) {
        const auto both = start + end, edge = end - start;
        const Doubles one = Doubles{} + 1.0;
        const Doubles along = least(greatest(-(both.dot(edge) * inverse), -one), one);
        const auto off = both + edge * along;
        Doubles squared = off.dot(off) * 0.25;
        squared = along <= -one ? at_start : squared;
        return along >= one ? at_end : squared;
    }
};

}  // namespace nisp
