// A matrix that an optimizer sees, whose numbers lie somewhere in the vector of weights.
#pragma once

#include "memory.h"
#include "network.h"

namespace nisp {

// [W | b] of a layer, or [embedding | slopes | offsets] with a row for each chart: `blocks` side by
// side, each row after row in the vector.
class OptimizerMatrix {
   public:
    int rows, columns = 0;

    static OptimizerMatrix of_layer(const Layer& layer) {
        OptimizerMatrix matrix(layer.outputs);
        matrix.append(layer.weight, layer.inputs);
        matrix.append(layer.bias, 1);
        return matrix;
    }
    static OptimizerMatrix of_tables(const Network& network) {
        OptimizerMatrix matrix(network.charts);
        size_t place = 0;
        for (int columns : {network.embedding, network.slope_columns, network.offset_columns}) {
            matrix.append(place, columns);
            place += static_cast<size_t>(columns) * network.charts;
        }
        return matrix;
    }

    void gather(const float* vector, Matrix& to) const {
        for (const Block& block : blocks_)
            for (int i = 0; i < rows; i++)
                std::copy_n(vector + block.place + static_cast<size_t>(i) * block.columns, block.columns,
                            to.row(i) + block.first);
    }
    // weights -= scale * direction
    void subtract(float* weights, float scale, const Matrix& direction) const {
        for (const Block& block : blocks_)
            for (int i = 0; i < rows; i++) {
                float* to = weights + block.place + static_cast<size_t>(i) * block.columns;
                const float* from = direction.row(i) + block.first;
                for (int j = 0; j < block.columns; j++) to[j] -= scale * from[j];
            }
    }

   private:
    struct Block {
        size_t place;
        int columns, first;
    };
    std::vector<Block> blocks_;

    explicit OptimizerMatrix(int rows) : rows(rows) {}
    void append(size_t place, int count) {
        if (count == 0) return;
        blocks_.push_back({place, count, columns});
        columns += count;
    }
};

}  // namespace nisp
