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
    Waiting stack_[MOST_WAITING];

    // Lets its children wait whose boxes are in reach, the nearest on top.
    void look_into(Place node) {
        const double* boxes = tree_.boxes[node.level] + int64_t(node.index) * BOX_ROWS * LANES;
        double bounds[LANES];
        for (int lane = 0; lane < LANES; lane += DOUBLES) store(bounds + lane, box_distances(boxes + lane));
        const int first = waiting_;
        for (int child = 0; child < LANES; child++) {
            if (!(bounds[child] < reach_)) continue;
            int place = waiting_++;
            for (; place > first && stack_[place - 1].bound < bounds[child]; place--) stack_[place] = stack_[place - 1];
            stack_[place] = {bounds[child], node.child(child)};
        }
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
        const auto a = load_three<Doubles>(rows), b = load_three<Doubles>(rows + 3 * LANES),
                   c = load_three<Doubles>(rows + 6 * LANES);
        const double* inverse = rows + 9 * LANES;
        const Doubles edges = least(least(to_edge(a, b, load<Doubles>(inverse)), to_edge(b, c, load<Doubles>(inverse + LANES))),
                                    to_edge(c, a, load<Doubles>(inverse + 2 * LANES)));
        const auto way = point_ - a;
        const Doubles v = way.dot(load_three<Doubles>(rows + 12 * LANES)), w = way.dot(load_three<Doubles>(rows + 15 * LANES));
        const auto off = way - (b - a) * v - (c - a) * w;
        const Doubles none = {}, inside = off.dot(off);
        const auto over = (v > none) & (w > none) & (v + w < none + 1.0);
        return over ? least(edges, inside) : edges;
    }

    Doubles to_edge(const Three<Doubles>& start, const Three<Doubles>& end, Doubles inverse) const {
        const auto middle = (start + end) * 0.5, half = (end - start) * 0.5;
        const Doubles one = Doubles{} + 1.0;
        const Doubles along = least(greatest((point_ - middle).dot(half) * inverse, -one), one);
        const auto between = middle + half * along;
        const auto at_end = along >= one, at_start = along <= -one;
        const Three<Doubles> closest = {
            at_end ? end.x : (at_start ? start.x : between.x),
            at_end ? end.y : (at_start ? start.y : between.y),
            at_end ? end.z : (at_start ? start.z : between.z),
        };
        const auto off = point_ - closest;
        return off.dot(off);
    }
};

}  // namespace nisp
