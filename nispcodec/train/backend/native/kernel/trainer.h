// One network under training: gradients, and whole steps of it.
#pragma once

#include <memory>

#include "losses.h"
#include "muon.h"
#include "pool.h"
#include "soap.h"

namespace nisp {

// A batch is cut into so many parts, whatever the number of threads, and each part adds up its own
// gradient: so the order of all sums, and every byte, is the same.
constexpr int LANES = 4;
// Tasks that many samples without gradients are cut into.
constexpr int SAMPLE_TASKS = 64;

class Trainer {
   public:
    Trainer(const Topology& topology, const Settings& settings, const Samples& samples, const float* kept)
        : network_(topology),
          settings_(settings),
          loss_(static_cast<Loss>(topology.loss)),
          samples_(samples),
          gradient_(network_.weight_count) {
        if (kept != nullptr) kept_.assign(kept, kept + network_.weight_count);
        for (int lane = 0; lane < LANES; lane++) lane_gradients_.emplace_back(network_.weight_count);
        make_optimizers();
        set_threads(1);
    }

    size_t weight_count() const { return network_.weight_count; }
    Soap* soap(int index) { return index < static_cast<int>(soaps_.size()) ? &soaps_[index] : nullptr; }
    const float* last_gradient() const { return gradient_.data(); }

    void set_threads(int threads) {
        if (pool_ && pool_->threads() == threads) return;
        while (static_cast<int>(workers_.size()) < threads)
            workers_.push_back(std::make_unique<Worker>(network_));
        pool_ = std::make_unique<Pool>(threads);
    }

    // The optimizers forget everything: the next step is a first one.
    void restart() {
        for (Muon& muon : muons_) muon.restart();
        for (Soap& soap : soaps_) soap.restart();
        phase_ = FIRST_STEP;
    }

    // After a first step each SOAP wants its bases, and then this.
    void resume() { phase_ = RUNNING; }

    // The mean loss of the samples `rows`; its gradient is then in last_gradient().
    double gradient(const float* weights, const int32_t* rows, int batch) {
        double losses[LANES];
        const int part = rounded_up((batch + LANES - 1) / LANES, VECTOR_LENGTH);
        pool_->run(LANES, [&](int lane, int worker) {
            const int begin = std::min(batch, lane * part), end = std::min(batch, begin + part);
            losses[lane] = lane_gradient(weights, rows, begin, end, batch, *workers_[worker],
                                         lane_gradients_[lane]);
        });
        add_lanes();
        return (losses[0] + losses[1]) + (losses[2] + losses[3]);
    }

    // Up to `count` steps, in place; returns how many. It ends after a first one, whose SOAPs want
    // their bases; does none while they still do.
    int steps(float* weights, float* mean, const int32_t* rows, int count, int batch, const float* rates,
              float* losses) {
        for (int done = 0; done < count; done++) {
            if (phase_ == WANTS_BASES) return done;
            losses[done] =
                static_cast<float>(gradient(weights, rows + static_cast<size_t>(done) * batch, batch));
            clip();
            move(weights, rates[done]);
            keep(weights);
            for (size_t i = 0; i < weight_count(); i++)
                mean[i] += settings_.ema_weight * (weights[i] - mean[i]);
            if (phase_ == FIRST_STEP) phase_ = WANTS_BASES;
        }
        return count;
    }

    // Outputs (n, outputs) of points (n, 3); charts may be null.
    void outputs(const float* weights, const float* points, const int32_t* charts, size_t count, float* to) {
        each_tile(count, [&](Tile& tile, size_t first, Buffer&) {
            place_points(tile, points, charts, first);
            tile.forward(weights);
            for (int s = 0; s < tile.count; s++)
                for (int o = 0; o < network_.outputs; o++)
                    to[(first + s) * network_.outputs + o] = tile.outputs()[o * ROW + s];
        });
    }

    // For each point the derivatives of direction . outputs by the weights at `places`, or by all
    // where that is null: (n, place_count). directions (n, outputs).
    void slopes(const float* weights, const float* points, const int32_t* charts, const float* directions,
                size_t count, const int64_t* places, size_t place_count, float* to) {
        each_tile(count, [&](Tile& tile, size_t first, Buffer& all_slopes) {
            place_points(tile, points, charts, first);
            tile.forward(weights);
            std::fill_n(tile.outputs(), network_.outputs * ROW, 0.0f);
            for (int s = 0; s < tile.count; s++)
                for (int o = 0; o < network_.outputs; o++)
                    tile.outputs()[o * ROW + s] = directions[(first + s) * network_.outputs + o];
            tile.backward(weights);
            for (int s = 0; s < tile.count; s++) {
                float* row = to + (first + s) * place_count;
                sample_slopes(tile, s, places ? all_slopes.data() : row);
                for (size_t i = 0; places && i < place_count; i++) row[i] = all_slopes[places[i]];
            }
        });
    }

   private:
    // What a thread needs for itself.
    struct Worker {
        Tile tile;
        Targets targets;
        Buffer sample_slopes;
        explicit Worker(const Network& network) : tile(network), sample_slopes(network.weight_count) {}
    };
    enum Phase { FIRST_STEP, WANTS_BASES, RUNNING };

    Network network_;
    Settings settings_;
    Loss loss_;
    Samples samples_;
    std::vector<float> kept_;  // 0 or 1; none: everything is kept
    Buffer gradient_;
    std::vector<Buffer> lane_gradients_;
    std::vector<Muon> muons_;
    std::vector<Soap> soaps_;
    Phase phase_ = FIRST_STEP;
    std::vector<std::unique_ptr<Worker>> workers_;
    std::unique_ptr<Pool> pool_;

    // Muon between hidden layers, SOAP for the first layer, the last and the tables, in this order.
    void make_optimizers() {
        const int last = network_.hidden_layers();
        int longest_side = 0;
        for (int i = 1; i < last; i++)
            longest_side =
                std::max({longest_side, network_.layers[i].outputs, network_.layers[i].inputs + 1});
        for (int i = 1; i < last; i++)
            muons_.emplace_back(OptimizerMatrix::of_layer(network_.layers[i]), longest_side);
        soaps_.emplace_back(OptimizerMatrix::of_layer(network_.layers[0]), settings_.w0);
        soaps_.emplace_back(OptimizerMatrix::of_layer(network_.layers[last]), settings_.last_layer_rate);
        if (network_.table_columns() > 0) soaps_.emplace_back(OptimizerMatrix::of_tables(network_), 1.0f);
    }

    // The loss and gradient of the rows from begin to end of a batch.
    double lane_gradient(const float* weights, const int32_t* rows, int begin, int end, int batch,
                         Worker& worker, Buffer& gradient) {
        gradient.clear();
        double loss = 0;
        for (int first = begin; first < end; first += TILE) {
            place_samples(worker, rows + first, std::min(TILE, end - first), batch);
            worker.tile.forward(weights);
            loss += tile_loss(worker);
            worker.tile.backward(weights);
            worker.tile.add_gradient(gradient.data());
        }
        return loss;
    }

    void place_samples(Worker& worker, const int32_t* rows, int count, int batch) {
        Targets& targets = worker.targets;
        worker.tile.begin(count);
        targets.begin(worker.tile, batch);
        for (int s = 0; s < count; s++) {
            const size_t row = rows[s];
            worker.tile.place(s, samples_.points + 3 * row, samples_.chart[row]);
            targets.sdf[s] = samples_.sdf[row];
            targets.uv[s] = samples_.uv[2 * row];
            targets.uv[ROW + s] = samples_.uv[2 * row + 1];
        }
    }

    double tile_loss(Worker& worker) {
        if (loss_ == SDF_LOSS) return sdf_loss(worker.tile, worker.targets, settings_);
        if (loss_ == CHART_LOSS) return chart_loss(worker.tile, worker.targets, network_);
        return uv_loss(worker.tile, worker.targets);
    }

    void add_lanes() {
        const float *a = lane_gradients_[0].data(), *b = lane_gradients_[1].data();
        const float *c = lane_gradients_[2].data(), *d = lane_gradients_[3].data();
        for (size_t i = 0; i < weight_count(); i++) gradient_[i] = (a[i] + b[i]) + (c[i] + d[i]);
        keep(gradient_.data());
    }

    void keep(float* vector) const {
        for (size_t i = 0; i < kept_.size(); i++) vector[i] *= kept_[i];
    }

    void clip() {
        const double norm = std::sqrt(square_sum(gradient_.data(), weight_count()));
        const float scale = static_cast<float>(settings_.clip / (norm + TINY));
        if (scale >= 1.0f) return;  // what is no number must show
        for (size_t i = 0; i < weight_count(); i++) gradient_[i] *= scale;
    }

    // Every matrix is a task of its own.
    void move(float* weights, double rate) {
        const int muons = static_cast<int>(muons_.size()), count = muons + static_cast<int>(soaps_.size());
        pool_->run(count, [&](int number, int) {
            if (number < muons)
                muons_[number].step(weights, gradient_.data(), rate, settings_);
            else
                soaps_[number - muons].step(weights, gradient_.data(), rate, settings_);
        });
    }

    // Calls body(tile, first sample, memory for a sample's slopes) for all tiles of `count` samples.
    template <class Body>
    void each_tile(size_t count, Body body) {
        const size_t tiles = (count + TILE - 1) / TILE;
        pool_->run(SAMPLE_TASKS, [&](int task, int number) {
            Worker& worker = *workers_[number];
            for (size_t i = tiles * task / SAMPLE_TASKS; i < tiles * (task + 1) / SAMPLE_TASKS; i++) {
                worker.tile.begin(static_cast<int>(std::min<size_t>(TILE, count - i * TILE)));
                body(worker.tile, i * TILE, worker.sample_slopes);
            }
        });
    }

    static void place_points(Tile& tile, const float* points, const int32_t* charts, size_t first) {
        for (int s = 0; s < tile.count; s++)
            tile.place(s, points + 3 * (first + s), charts ? charts[first + s] : 0);
    }

    // One sample's derivatives by all weights, after `backward`.
    void sample_slopes(const Tile& tile, int s, float* to) const {
        std::fill_n(to, network_.layers[0].weight, 0.0f);
        for (int column = 0; column < network_.table_columns(); column++)
            to[network_.table_place(tile.charts()[s], column)] = tile.table_derivatives()[column * ROW + s];
        for (int i = 0; i <= network_.hidden_layers(); i++) {
            const Layer& layer = network_.layers[i];
            const float *input = tile.activations(i) + s, *derivative = tile.derivatives(i) + s;
            float* weight = to + layer.weight;
            for (int o = 0; o < layer.outputs; o++) {
                to[layer.bias + o] = derivative[o * ROW];
                for (int k = 0; k < layer.inputs; k++) *weight++ = derivative[o * ROW] * input[k * ROW];
            }
        }
    }
};

}  // namespace nisp
