// Topology of a network, and where in the one vector of its weights everything is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nisp {

// As the Python side fills it (`library.py`, Topology). Change both together, and the version.
struct Topology {
    int32_t mirror;  // bits 0 to 2: axes that enter as absolute values; 3 to 5: signed ones behind
    int32_t hidden_layers;
    const int32_t* widths;  // of the hidden layers
    int32_t outputs;
    int32_t charts;     // 0 where nothing depends on the chart
    int32_t embedding;  // numbers a chart
    int32_t affine;     // 1: an affine map of the coordinates for each chart
    int32_t loss;       // a Loss
};

enum Loss : int32_t { SDF_LOSS = 0, CHART_LOSS = 1, UV_LOSS = 2 };

// weight is (outputs, inputs), bias (outputs,); both are places in the vector.
struct Layer {
    int inputs, outputs;
    size_t weight, bias;
};

class Network {
   public:
    int mirror, outputs, charts, embedding;
    bool affine;
    int coordinates;  // of a point, signed axes included
    // The columns of the tables, a row for each chart: embedding, slopes, offsets.
    int slope_columns, offset_columns;
    size_t weight_count = 0;
    std::vector<Layer> layers;

    explicit Network(const Topology& topology)
        : mirror(topology.mirror),
          outputs(topology.outputs),
          charts(topology.charts),
          embedding(topology.embedding),
          affine(topology.affine != 0),
          coordinates(3 + __builtin_popcount(topology.mirror >> 3 & 7)),
          slope_columns(affine ? outputs * coordinates : 0),
          offset_columns(affine ? outputs : 0) {
        weight_count = static_cast<size_t>(charts) * table_columns();
        int inputs = coordinates + embedding;
        for (int i = 0; i <= topology.hidden_layers; i++) {
            const int width = i < topology.hidden_layers ? topology.widths[i] : outputs;
            const size_t weight = weight_count, bias = weight + static_cast<size_t>(width) * inputs;
            layers.push_back({inputs, width, weight, bias});
            weight_count = bias + width;
            inputs = width;
        }
    }

    int hidden_layers() const { return static_cast<int>(layers.size()) - 1; }
    int table_columns() const { return embedding + slope_columns + offset_columns; }

    // Where in the vector the number of a chart is: the tables are one after the other.
    size_t table_place(int chart, int column) const {
        if (column < embedding) return static_cast<size_t>(chart) * embedding + column;
        size_t table = static_cast<size_t>(charts) * embedding;
        column -= embedding;
        if (column < slope_columns) return table + static_cast<size_t>(chart) * slope_columns + column;
        table += static_cast<size_t>(charts) * slope_columns;
        return table + static_cast<size_t>(chart) * offset_columns + column - slope_columns;
    }
};

}  // namespace nisp
