// The nearest sample on the right side of a surface, by cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace nisp {

class NearestGrid {
   public:
    // points (count, 3), finite, count at least 1.
    NearestGrid(const float* points, int32_t count) : count_(count), numbers_(count), sorted_(3 * size_t(count)) {
        measure(points);
        std::vector<int32_t> cell_of(count);
        first_.assign(static_cast<size_t>(sides_[0]) * sides_[1] * sides_[2] + 1, 0);
        for (int32_t i = 0; i < count; i++) {
            cell_of[i] = cell(points + 3 * size_t(i));
            first_[cell_of[i] + 1]++;
        }
        for (size_t i = 1; i < first_.size(); i++) first_[i] += first_[i - 1];
        std::vector<int32_t> next(first_.begin(), first_.end() - 1);
        for (int32_t i = 0; i < count; i++) {
            const int32_t place = next[cell_of[i]]++;
            numbers_[place] = i;
            std::memcpy(&sorted_[3 * size_t(place)], points + 3 * size_t(i), 3 * sizeof(float));
        }
    }

    int32_t count() const { return count_; }

    // As nispcodec.dataset.hard_examples.error_radii.
    void error_radii(const float* sdf, const float* field, double limit, bool floaters, float* radii) const {
        std::vector<uint8_t> inside(count_);
        for (int32_t k = 0; k < count_; k++) inside[k] = field[numbers_[k]] < 0;
        for (int32_t k = 0; k < count_; k++) {
            const int32_t i = numbers_[k];
            const bool wanted = sdf[i] < 0, wrong = (inside[k] != 0) != wanted;
            radii[i] = wrong ? static_cast<float>(nearest(&sorted_[3 * size_t(k)], inside, wanted, limit)) : 0;
            const float distance = std::fabs(sdf[i]);
            if (floaters && radii[i] > 0 && distance > static_cast<float>(limit)) radii[i] = distance;
        }
    }

   private:
    int32_t count_;
    float low_[3];
    int sides_[3];
    double edge_;
    std::vector<int32_t> first_;    // of each cell, in the order of cells
    std::vector<int32_t> numbers_;  // in the order of cells, which sample it is ...
    std::vector<float> sorted_;     // ... and where

    // Cells that are cubes, about as many as there are points, and at least a few along the longest
    // side. Samples crowd at a surface, so a cell that has any has many.
    void measure(const float* points) {
        float high[3];
        std::memcpy(low_, points, sizeof low_);
        std::memcpy(high, points, sizeof high);
        for (size_t i = 0; i < 3 * size_t(count_); i++) {
            low_[i % 3] = std::min(low_[i % 3], points[i]);
            high[i % 3] = std::max(high[i % 3], points[i]);
        }
        double longest = 0;
        for (int axis = 0; axis < 3; axis++) longest = std::max(longest, double(high[axis]) - low_[axis]);
        const double along = std::max(1.0, std::floor(std::cbrt(2.0 * count_)));
        edge_ = longest > 0 ? longest / along : 1.0;
        for (int axis = 0; axis < 3; axis++)
            sides_[axis] = static_cast<int>((double(high[axis]) - low_[axis]) / edge_) + 1;
    }

    int index(const float* point, int axis) const {
        return static_cast<int>((double(point[axis]) - low_[axis]) / edge_);
    }
    int32_t cell(const float* point) const {
        return (index(point, 0) * sides_[1] + index(point, 1)) * sides_[2] + index(point, 2);
    }

    // Distance to the nearest sample of the wanted side, `limit` if there is none so near: cells in
    // rings around the point's own, until a ring is further away than what was found.
    double nearest(const float* point, const std::vector<uint8_t>& inside, bool wanted, double limit) const {
        const int center[3] = {index(point, 0), index(point, 1), index(point, 2)};
        const int most = std::max({sides_[0], sides_[1], sides_[2]});
        double best = limit * limit;
        bool found = false;
        for (int ring = 0; ring < most; ring++) {
            const double distance = (ring - 1) * edge_;
            if (ring > 0 && distance * distance >= best) break;
            each_run(center, ring, [&](int32_t begin, int32_t end) {
                for (int32_t k = begin; k < end; k++) {
                    const double squared = squared_distance(point, &sorted_[3 * size_t(k)]);
                    if (squared < best && (inside[k] != 0) == wanted) {
                        best = squared;
                        found = true;
                    }
                }
            });
        }
        return found ? std::sqrt(best) : limit;
    }

    static double squared_distance(const float* a, const float* b) {
        const double x = double(a[0]) - b[0], y = double(a[1]) - b[1], z = double(a[2]) - b[2];
        return x * x + y * y + z * z;
    }

    // Calls body(begin, end) for the samples in the cells that are `ring` cells from the center:
    // whole rows along z where x or y is, else both ends.
    template <class Body>
    void each_run(const int* center, int ring, Body body) const {
        const auto row = [&](int x, int y, int from, int to) {
            from = std::max(from, 0);
            to = std::min(to, sides_[2] - 1);
            if (from > to) return;
            const size_t start = (static_cast<size_t>(x) * sides_[1] + y) * sides_[2];
            body(first_[start + from], first_[start + to + 1]);
        };
        const int z = center[2];
        for (int x = std::max(0, center[0] - ring); x <= std::min(sides_[0] - 1, center[0] + ring); x++)
            for (int y = std::max(0, center[1] - ring); y <= std::min(sides_[1] - 1, center[1] + ring); y++)
                if (std::abs(x - center[0]) == ring || std::abs(y - center[1]) == ring) {
                    row(x, y, z - ring, z + ring);
                } else {
                    row(x, y, z - ring, z - ring);
                    row(x, y, z + ring, z + ring);
                }
    }
};

}  // namespace nisp
