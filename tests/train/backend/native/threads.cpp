// Steps, outputs and slopes of two networks on several threads, without Python: what a sanitizer of
// threads looks at. Ends with an error where a step asks for memory, which threads of a pool must not.
#include <cstdio>
#include <random>

#include "trainer.h"

namespace {

std::atomic<bool> forbidden{false};

void expect_allowed() {
    if (!forbidden.load()) return;
    std::fputs("memory was asked for within a step\n", stderr);
    std::_Exit(2);
}

}  // namespace

void* operator new(std::size_t size) {
    expect_allowed();
    if (void* found = std::malloc(size)) return found;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

// The linker puts this in the place of the C library's.
extern "C" void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
extern "C" void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
    expect_allowed();
    return __real_aligned_alloc(alignment, size);
}

namespace {

constexpr int SAMPLES = 3000, BATCH = 200, STEPS = 25, CHARTS = 3;

struct RandomSamples {
    std::vector<float> points, sdf, uv;
    std::vector<int32_t> chart, rows;

    RandomSamples() : points(3 * SAMPLES), sdf(SAMPLES), uv(2 * SAMPLES), chart(SAMPLES), rows(STEPS * BATCH) {
        std::mt19937 random(0);
        std::uniform_real_distribution<float> uniform(-1, 1);
        for (std::vector<float>* each : {&points, &sdf, &uv})
            for (float& number : *each) number = uniform(random);
        for (int32_t& each : chart) each = static_cast<int32_t>(random() % CHARTS);
        for (int32_t& each : rows) each = static_cast<int32_t>(random() % SAMPLES);
    }
    nisp::Samples pointers() const { return {points.data(), sdf.data(), chart.data(), uv.data()}; }
};

nisp::Settings settings() {
    return {0.01f, 1.8f, 2e-3f, 30.0f, 0.3f, 0.01f, 1.0f, 0.7, 20, 400, 0.01,
            {3.4445f, -4.775f, 2.0315f}, 5, 0.95, 1e-8, 2};
}

// Bases in which nothing is diagonal yet: the threads do the same work with any.
void begin_soaps(nisp::Trainer& trainer) {
    for (int index = 0; nisp::Soap* soap = trainer.soap(index); index++) {
        std::vector<float> left(soap->rows() * soap->rows()), right(soap->columns() * soap->columns());
        for (int i = 0; i < soap->rows(); i++) left[i * soap->rows() + i] = 1;
        for (int i = 0; i < soap->columns(); i++) right[i * soap->columns() + i] = 1;
        soap->begin(left.data(), right.data());
    }
    trainer.resume();
}

void drive(const nisp::Topology& topology) {
    const RandomSamples samples;
    const nisp::Settings told = settings();
    nisp::Trainer trainer(topology, told, samples.pointers(), nullptr);
    const size_t count = trainer.weight_count();
    std::vector<float> weights(count), mean(count), rates(STEPS, 1e-3f), losses(STEPS);
    std::vector<float> outputs(SAMPLES * topology.outputs), slopes(BATCH * count);
    std::mt19937 random(1);
    for (float& weight : weights) weight = std::uniform_real_distribution<float>(-0.1f, 0.1f)(random);
    const auto steps = [&](int number) {
        trainer.steps(weights.data(), mean.data(), samples.rows.data(), number, BATCH, rates.data(),
                      losses.data());
    };
    steps(1);
    begin_soaps(trainer);
    for (int threads : {4, 1, 3}) {
        trainer.set_threads(threads);
        forbidden.store(true);
        steps(STEPS);
        trainer.outputs(weights.data(), samples.points.data(), samples.chart.data(), SAMPLES, outputs.data());
        trainer.slopes(weights.data(), samples.points.data(), samples.chart.data(), outputs.data(), BATCH,
                       nullptr, 0, slopes.data());
        forbidden.store(false);
    }
}

}  // namespace

int main() {
    const int32_t widths[] = {24, 20, 24};
    drive({0, 3, widths, 1, 0, 0, 0, nisp::SDF_LOSS});
    drive({1, 3, widths, 2, CHARTS, 4, 1, nisp::UV_LOSS});
    return 0;
}
