// A few threads that take numbered tasks.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace nisp {

// Tasks must not depend on who does them or in what order; then results do not either.
class Pool {
   public:
    explicit Pool(int threads) {
        try {
            for (int worker = 1; worker < threads; worker++)
                workers_.emplace_back([this, worker] { work(worker); });
        } catch (...) {  // A thread that could not be made; the others must not be left running.
            stop();
            throw;
        }
    }
    ~Pool() { stop(); }
    int threads() const { return static_cast<int>(workers_.size()) + 1; }

    // Calls task(number, worker) for the numbers from 0 to count - 1, below 2^15; returns
    // when all are done. The caller is worker 0. A task may not throw, and so may ask for no memory.
    template <class Task>
    void run(int count, const Task& task) {
        if (workers_.empty() || count <= 1) {
            for (int number = 0; number < count; number++) task(number, 0);
            return;
        }
        task_ = std::cref(task);  // A copy could need memory.
        done_.store(0, std::memory_order_relaxed);
        const uint64_t job = job_of(state_.load(std::memory_order_relaxed)) + 1;
        {
            // Under the lock, or a worker that is about to wait would miss it.
            std::lock_guard<std::mutex> lock(mutex_);
            state_.store(job << 32 | static_cast<uint64_t>(count) << 16);
        }
        if (asleep_.load() > 0) wake_.notify_all();
        take_tasks(job, 0);
        for (int turns = 0; done_.load(std::memory_order_acquire) < count; turns++)
            if (turns > SPINS) std::this_thread::yield();
    }

   private:
    void stop() {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            stopped_.store(true);
        }
        wake_.notify_all();
        for (std::thread& worker : workers_) worker.join();
    }

    // Looks for work before a worker waits for it: some ten microseconds, as between two parts of a
    // step.
    static constexpr int SPINS = 2000;

    // Which job it is, how many tasks it has and which is the next, in one number: so a worker that
    // comes late cannot take a task of a job whose function it does not know.
    std::atomic<uint64_t> state_{0};
    std::atomic<int> done_{0}, asleep_{0};
    std::atomic<bool> stopped_{false};
    std::function<void(int, int)> task_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<std::thread> workers_;

    static uint64_t job_of(uint64_t state) { return state >> 32; }
    static int count_of(uint64_t state) { return static_cast<int>(state >> 16 & 0xffff); }
    static int next_of(uint64_t state) { return static_cast<int>(state & 0xffff); }

    // A task that was taken keeps its job from ending, and so `task_` from changing.
    void take_tasks(uint64_t job, int worker) {
        uint64_t state = state_.load(std::memory_order_acquire);
        while (job_of(state) == job && next_of(state) < count_of(state)) {
            if (!state_.compare_exchange_weak(state, state + 1, std::memory_order_acq_rel)) continue;
            task_(next_of(state), worker);
            done_.fetch_add(1, std::memory_order_release);
            state = state_.load(std::memory_order_acquire);
        }
    }

    void work(int worker) {
        uint64_t seen = 0;
        while (true) {
            seen = next_job(seen);
            if (stopped_.load()) return;
            take_tasks(seen, worker);
        }
    }

    // The number of a job after `seen`, or of any when the pool is stopped.
    uint64_t next_job(uint64_t seen) {
        const auto is_there = [&] { return stopped_.load() || job_of(state_.load()) != seen; };
        for (int turns = 0; turns < SPINS; turns++) {
            if (is_there()) return job_of(state_.load());
#if defined(__x86_64__)
            __builtin_ia32_pause();
#endif
        }
        std::unique_lock<std::mutex> lock(mutex_);
        asleep_.fetch_add(1);
        wake_.wait(lock, is_there);
        asleep_.fetch_sub(1);
        return job_of(state_.load());
    }
};

}  // namespace nisp
