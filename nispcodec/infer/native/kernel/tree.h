// Triangles in a tree of boxes: `nispcodec.infer.mesh_tree` and `multipoles` say what is where.
#pragma once

#include <cstdint>

#include "lanes.h"

namespace nisp {

constexpr int BOX_ROWS = 6, CLUSTER_ROWS = 13, TRIANGLE_ROWS = 18;
// Each level has eight times the nodes of the one before, and faces are counted in 31 bits.
constexpr int MOST_LEVELS = 12;
// Of a node that is looked into, eight at most wait; and so at each level.
constexpr int MOST_WAITING = MOST_LEVELS * LANES;

// As `_Tree` of mesh_kernel.py.
struct Tree {
    int32_t levels;
    const double* boxes[MOST_LEVELS];    // of each level (nodes, BOX_ROWS, LANES)
    const float* clusters[MOST_LEVELS];  // of each level (nodes, CLUSTER_ROWS, LANES)
    const double* triangles;             // (leaves, TRIANGLE_ROWS, LANES)
    const int32_t* faces;                // (leaves, LANES)
    const float* solid;                  // (leaves, LANES): 1 where the triangle counts for what is inside
};

// A node, or, on the level after the last, a leaf.
struct Place {
    int32_t level, index;

    Place child(int number) const { return {level + 1, LANES * index + number}; }
};

}  // namespace nisp
