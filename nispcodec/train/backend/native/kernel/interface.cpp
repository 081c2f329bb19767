// What Python calls (`library.py`). It has checked every size and every index before.
//
// Nothing here throws: what makes an object returns null when there is no memory for it.

#include "../../../../core/kernel/exports.h"

#include <memory>

#include "nearest_grid.h"
#include "trainer.h"

#if defined(__x86_64__)
#define NISP_IN_REGISTER(vector) "+v"(vector)
#else
#define NISP_IN_REGISTER(vector) "+w"(vector)
#endif

using nisp::NearestGrid;
using nisp::Trainer;

namespace {

template <class Make>
auto made(Make make) noexcept -> decltype(make()) {
    try {
        return make();
    } catch (...) {
        return nullptr;
    }
}

// Runs `body`; false when it found no memory, or no thread.
template <class Body>
int32_t succeeds(Body body) noexcept {
    try {
        body();
        return 1;
    } catch (...) {
        return 0;
    }
}

}  // namespace


// To be raised with every change of what is below, or of a struct.
EXPORTED int32_t nisp_version() { return 1; }

EXPORTED int32_t nisp_vector_length() { return nisp::VECTOR_LENGTH; }

// What steps are measured against: `rounds` times PEAK_SUMS multiplications and additions of vectors
// that nothing but the arithmetic units holds up. Returns how many of floats that were.
EXPORTED int64_t nisp_peak(int64_t rounds) {
    constexpr int PEAK_SUMS = 12;
    nisp::Vector sums[PEAK_SUMS] = {}, factor = nisp::all(0.5f), term = nisp::all(1.0f);
    for (int64_t round = 0; round < rounds; round++)
        for (nisp::Vector& sum : sums) {
            sum = sum * factor + term;
            // Or the compiler would take several rounds together.
            asm volatile("" : NISP_IN_REGISTER(sum));
        }
    return rounds * PEAK_SUMS * nisp::VECTOR_LENGTH;
}

EXPORTED Trainer* nisp_trainer_new(const nisp::Topology* topology, const nisp::Settings* settings,
                          const nisp::Samples* samples, const float* kept) {
    return made([&] { return new Trainer(*topology, *settings, *samples, kept); });
}
EXPORTED void nisp_trainer_free(Trainer* trainer) { delete trainer; }


EXPORTED int32_t nisp_set_threads(Trainer* trainer, int32_t threads) {
    return succeeds([&] { trainer->set_threads(threads); });
}

EXPORTED void nisp_restart(Trainer* trainer) { trainer->restart(); }
EXPORTED void nisp_resume(Trainer* trainer) { trainer->resume(); }

EXPORTED float nisp_gradient(Trainer* trainer, const float* weights, const int32_t* rows, int32_t batch,
                    float* gradient) {
    const double loss = trainer->gradient(weights, rows, batch);
    std::copy_n(trainer->last_gradient(), trainer->weight_count(), gradient);
    return static_cast<float>(loss);
}

// How many steps were done, or -1 without memory.
EXPORTED int32_t nisp_steps(Trainer* trainer, float* weights, float* mean, const int32_t* rows, int32_t count,
                   int32_t batch, const float* rates, float* losses) {
    int32_t done = -1;
    succeeds([&] { done = trainer->steps(weights, mean, rows, count, batch, rates, losses); });
    return done;
}

// The size of the gradient that SOAP number `index` sees, 0 where there is no such; and itself,
// unless `gradient` is null.
EXPORTED int32_t nisp_soap_gradient(Trainer* trainer, int32_t index, int32_t* rows, int32_t* columns,
                           float* gradient) {
    const nisp::Soap* soap = trainer->soap(index);
    if (soap == nullptr) return 0;
    *rows = soap->rows();
    *columns = soap->columns();
    if (gradient != nullptr) soap->write_gradient(gradient);
    return 1;
}
EXPORTED void nisp_soap_begin(Trainer* trainer, int32_t index, const float* left, const float* right) {
    trainer->soap(index)->begin(left, right);
}

EXPORTED void nisp_outputs(Trainer* trainer, const float* weights, const float* points, const int32_t* charts,
                  int64_t count, float* outputs) {
    trainer->outputs(weights, points, charts, count, outputs);
}

EXPORTED void nisp_slopes(Trainer* trainer, const float* weights, const float* points, const int32_t* charts,
                 const float* directions, int64_t count, const int64_t* places, int64_t place_count,
                 float* slopes) {
    trainer->slopes(weights, points, charts, directions, count, places, place_count, slopes);
}

EXPORTED NearestGrid* nisp_grid_new(const float* points, int32_t count) {
    return made([&] { return new NearestGrid(points, count); });
}
EXPORTED void nisp_grid_free(NearestGrid* grid) { delete grid; }

EXPORTED int32_t nisp_error_radii(const NearestGrid* grid, const float* sdf, const float* field, double limit,
                         int32_t floaters, float* radii) {
    return succeeds([&] { grid->error_radii(sdf, field, limit, floaters != 0, radii); });
}
