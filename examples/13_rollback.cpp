/// @file 13_rollback.cpp
/// Two players push and blast a bar over a network link. The other's inputs come up to eight frames late: the game
/// goes on with a guess and, where that was wrong, goes back and computes the frames again, to the same bits.
///
/// C++11 or later. The game has threads of its own and lends them to the library.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr std::uint32_t frames = 600, most_late = 8, threads = 4;
constexpr std::uint16_t columns = 160, rows = 48;
constexpr double dt = 1.0 / 60; // s

/* ------------------------------------------------------------------------------------------------ the pool */

/// The game's threads: one parallel-for at a time, the caller being worker 0.
class task_pool {
  public:
    explicit task_pool(std::uint32_t count) {
        try {
            for (std::uint32_t worker = 1; worker < count; ++worker)
                others.emplace_back([this, worker] { serve(worker); });
        } catch (...) {
            stop();
            throw;
        }
    }
    ~task_pool() {
        stop();
    }
    task_pool(const task_pool &) = delete;
    task_pool &operator=(const task_pool &) = delete;

    /// What a network's definition needs. The pool must outlive the network.
    mspring_tasks tasks() noexcept {
        mspring_tasks lent = mspring_tasks_default();
        lent.worker_count = lent.concurrent_count = static_cast<std::uint32_t>(others.size() + 1);
        lent.run = [](std::uint32_t count, mspring_task_fn fn, void *argument, void *user) {
            static_cast<task_pool *>(user)->run(count, fn, argument);
        };
        lent.user = this;
        return lent;
    }
    std::uint64_t runs() const noexcept {
        return run_count;
    }

  private:
    void run(std::uint32_t count, mspring_task_fn fn, void *argument) {
        std::unique_lock<std::mutex> lock(mutex);
        ++run_count;
        task = {fn, argument, count, 0, 0};
        work.notify_all();
        take_part(lock, 0);
        done.wait(lock, [this] { return task.finished == task.count; });
    }
    void serve(std::uint32_t worker) {
        std::unique_lock<std::mutex> lock(mutex);
        while (!stopping) {
            take_part(lock, worker);
            work.wait(lock, [this] { return stopping || task.next < task.count; });
        }
    }
    // Each thread takes one index at a time, so up to `threads` calls run at once and may wait for each other.
    void take_part(std::unique_lock<std::mutex> &lock, std::uint32_t worker) {
        while (task.next < task.count) {
            const std::uint32_t index = task.next++;
            lock.unlock();
            task.fn(task.argument, index, worker);
            lock.lock();
            if (++task.finished == task.count)
                done.notify_one();
        }
    }
    void stop() {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            stopping = true;
        }
        work.notify_all();
        for (std::thread &other : others)
            other.join();
    }

    struct loop {
        mspring_task_fn fn;
        void *argument;
        std::uint32_t count, next, finished;
    };
    std::mutex mutex;
    std::condition_variable work, done;
    loop task = {};
    bool stopping = false;
    std::uint64_t run_count = 0;
    std::vector<std::thread> others;
};

/* ----------------------------------------------------------------------------------------------- the world */

struct input {
    std::int8_t push; ///< -1, 0 or 1
    bool blast;
    bool operator==(const input &other) const {
        return push == other.push && blast == other.blast;
    }
};
using inputs = std::array<input, 2>; ///< of both players

struct destroy {
    void operator()(mspring_builder *builder) const noexcept {
        mspring_builder_destroy(builder);
    }
    void operator()(mspring_network *network) const noexcept {
        mspring_network_destroy(network);
    }
};
using builder_ptr = std::unique_ptr<mspring_builder, destroy>;
using network_ptr = std::unique_ptr<mspring_network, destroy>;

[[noreturn]] void fail(mspring_result result, const char *message) {
    throw std::runtime_error(std::string(mspring_result_string(result)) + ": " + message);
}

/// A bar on a floor that the players push and blast at its ends.
class world {
  public:
    using snapshot = std::vector<unsigned char>;

    /// @param pool  nullptr: the calling thread alone
    explicit world(task_pool *pool) : network(make(pool)) {
        const double ground[4] = {0, -1, 0, 1}; // a point, and the way up from it
        mspring_floor_def floor = mspring_floor_def_default();
        floor.plane_count = 1;
        floor.planes = ground;
        floor.friction = 0.5f;
        check(mspring_network_set_floor(network.get(), &floor));
    }

    /// One frame: a function of the state and the inputs, and of nothing else.
    void advance(const inputs &now) {
        for (std::uint32_t player = 0; player < now.size(); ++player) {
            const mspring_id end = player == 0 ? 0 : columns - 1; // upper corners of the bar
            if (now[player].push != 0)
                check(mspring_network_apply_force(network.get(), end, 4000.0f * now[player].push, 4000.0f));
            if (now[player].blast)
                blast(end);
        }
        check(mspring_network_step(network.get(), dt));
    }

    void save(snapshot &to) const {
        std::size_t size = 0;
        check(mspring_network_get_snapshot_size(network.get(), MSPRING_SNAPSHOT_FRAME, &size));
        to.resize(size); // allocates in the first frames only
        check(mspring_network_save(network.get(), MSPRING_SNAPSHOT_FRAME, to.data(), to.size(), nullptr));
    }
    void load(const snapshot &from) {
        check(mspring_network_load(network.get(), from.data(), from.size()));
    }

    std::uint64_t hash() const {
        std::uint64_t bits = 0;
        check(mspring_network_get_state_hash(network.get(), &bits));
        return bits;
    }
    std::size_t broken_springs() const {
        std::vector<std::uint32_t> flags(mspring_network_count(network.get(), MSPRING_SPRINGS));
        check(mspring_network_get_integers(network.get(), MSPRING_SPRING_FLAGS, nullptr, 0,
                                           static_cast<std::uint32_t>(flags.size()), flags.data(), 1));
        return static_cast<std::size_t>(std::count_if(
            flags.begin(), flags.end(), [](std::uint32_t f) { return (f & MSPRING_SPRING_BROKEN) != 0; }));
    }

  private:
    static network_ptr make(task_pool *pool) {
        mspring_builder *built = nullptr;
        mspring_result result = mspring_builder_create(nullptr, &built);
        const builder_ptr builder(built);
        mspring_material wood = mspring_material_default();
        wood.mass = 10.0f;
        wood.stiffness = 1e6f;
        wood.damping = 300.0f;
        wood.break_strain = 0.02f;
        mspring_lattice_def bar = mspring_lattice_def_default();
        bar.width = columns;
        bar.height = rows;
        bar.materials = &wood;
        mspring_builder_add_lattice(builder.get(), &bar, nullptr); // create returns it if this fails
        mspring_tasks tasks;
        mspring_network_def def = mspring_network_def_default();
        def.settings.substeps = 16;
        if (pool) {
            tasks = pool->tasks();
            def.tasks = &tasks;
        }
        mspring_network *network = nullptr;
        if (result == MSPRING_OK)
            result = mspring_network_create(builder.get(), &def, &network);
        if (result != MSPRING_OK)
            fail(result, mspring_builder_error(builder.get()));
        return network_ptr(network);
    }

    // Everything near flies up.
    void blast(mspring_id centre) {
        double x = 0, y = 0;
        std::uint32_t count = 0;
        check(mspring_network_get_positions(network.get(), nullptr, centre, 1, &x, &y, 1));
        check(mspring_network_particles_in_circle(network.get(), x, y, 6.0, nullptr, 0, &count));
        hit.resize(count);
        check(mspring_network_particles_in_circle(network.get(), x, y, 6.0, hit.data(), count, &count));
        const float sideways = 0.0f, upwards = 150.0f; // N s
        check(mspring_network_apply_forces(network.get(), MSPRING_PUSH_IMPULSE, hit.data(), 0, count, &sideways,
                                           &upwards, 0));
    }
    void check(mspring_result result) const {
        if (result != MSPRING_OK)
            fail(result, mspring_network_error(network.get()));
    }

    network_ptr network;
    std::vector<mspring_id> hit;
};

/* -------------------------------------------------------------------------------------------------- a match */

/// What both players did in each frame, and the frame in which the second one's input arrives here.
struct match {
    std::vector<inputs> played = std::vector<inputs>(frames);
    std::vector<std::uint32_t> arrival = std::vector<std::uint32_t>(frames);

    match() {
        std::uint32_t random = 12345;
        const auto below = [&random](std::uint32_t limit) {
            random = random * 1664525u + 1013904223u;
            return (random >> 16) % limit;
        };
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            for (std::size_t player = 0; player < 2; ++player) {
                const bool holds = frame > 0 && below(12) != 0; // keys stay down for a while
                played[frame][player].push = holds ? played[frame - 1][player].push : std::int8_t(below(3)) - 1;
                played[frame][player].blast = below(40) == 0;
            }
            arrival[frame] = frame + 1 + below(most_late);
        }
    }
};

/// The game as the first player sees it.
class session {
  public:
    session(const match &of, task_pool &pool) : game(of), simulated(&pool), hashes(frames), known(frames, false) {
    }

    void play(std::uint32_t now) {
        const std::uint32_t wrong = receive(now);
        if (wrong < now) {
            ++rollbacks;
            resimulated += now - wrong;
            simulated.load(saved[wrong % saved.size()]);
            for (std::uint32_t frame = wrong; frame < now; ++frame)
                simulate(frame);
        }
        if (now < frames)
            simulate(now);
    }

    std::uint32_t rollbacks = 0, resimulated = 0;
    const std::vector<std::uint64_t> &all_hashes() const {
        return hashes;
    }
    std::size_t broken_springs() const {
        return simulated.broken_springs();
    }

  private:
    // Take what has arrived. Returns the first frame that was computed with another input, or now.
    std::uint32_t receive(std::uint32_t now) {
        std::uint32_t wrong = now;
        for (std::uint32_t frame = now > most_late ? now - most_late : 0; frame < std::min(now, frames); ++frame) {
            if (known[frame] || game.arrival[frame] > now)
                continue;
            known[frame] = true;
            if (!(game.played[frame][1] == used[frame % used.size()]))
                wrong = std::min(wrong, frame);
        }
        return wrong;
    }
    // One frame from the state at its begin, which is kept.
    void simulate(std::uint32_t frame) {
        inputs now = game.played[frame];
        if (!known[frame])
            now[1] = guess(frame);
        used[frame % used.size()] = now[1];
        simulated.save(saved[frame % saved.size()]);
        simulated.advance(now);
        hashes[frame] = simulated.hash();
    }
    // The keys are still as they were when last heard of, and nobody blasts twice.
    input guess(std::uint32_t frame) const {
        while (frame > 0 && !known[frame])
            --frame;
        return {known[frame] ? game.played[frame][1].push : std::int8_t(0), false};
    }

    const match &game;
    world simulated;
    std::array<world::snapshot, most_late + 1> saved; ///< at the begin of a frame
    std::array<input, most_late + 1> used = {};       ///< of the second player
    std::vector<std::uint64_t> hashes;                ///< at the end of a frame
    std::vector<bool> known;
};

std::vector<std::uint64_t> hashes_of_known_inputs(const match &game) {
    world simulated(nullptr);
    std::vector<std::uint64_t> hashes;
    for (const inputs &now : game.played) {
        simulated.advance(now);
        hashes.push_back(simulated.hash());
    }
    return hashes;
}

bool run() {
    const match game;
    task_pool pool(threads);
    session seen(game, pool);
    std::vector<double> milliseconds;
    for (std::uint32_t frame = 0; frame < frames + most_late; ++frame) { // the last inputs arrive after the end
        const auto begun = std::chrono::steady_clock::now();
        seen.play(frame);
        milliseconds.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
    }
    std::sort(milliseconds.begin(), milliseconds.end());
    std::printf("%u frames of a bar of %u x %u particles, inputs 1 to %u frames late\n", frames, unsigned(columns),
                unsigned(rows), most_late);
    std::printf("went back %u times, computed %u frames again, broke %zu springs\n", seen.rollbacks,
                seen.resimulated, seen.broken_springs());
    std::printf("a frame took %.2f ms (median), %.2f ms (most) of %.2f; %u threads were lent %llu times\n",
                milliseconds[milliseconds.size() / 2], milliseconds.back(), 1e3 * dt, threads,
                static_cast<unsigned long long>(pool.runs()));

    const std::vector<std::uint64_t> known = hashes_of_known_inputs(game);
    std::uint32_t same = 0;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
        same += known[frame] == seen.all_hashes()[frame];
    std::printf("state %016llx: %u of %u frames have the bits of a run that knew all inputs, on one thread\n",
                static_cast<unsigned long long>(known.back()), same, frames);
    return same == frames && seen.rollbacks > 0;
}

} // namespace

int main() {
    try {
        return run() ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
