#include "tasks/tasks.h"

#include "base/cpu.h"
#include "base/structs.h"
#include "tasks/pool.h"

/// Steps that are not divided after one whose bodies one worker took, at first and at most.
#define SHORTEST_PATIENCE 4u
#define LONGEST_PATIENCE 1024u

struct mspringi_tasks {
    mspringi_pool *pool; ///< NULL: the host's threads
    mspring_tasks host;
    uint32_t worker_count, concurrency;
    uint32_t counter_count; ///< initialised counters
    bool was_divided;       ///< bodies were run since the last judgement
    bool was_spread;        ///< and several workers took those of a run
    uint32_t patience;      ///< steps that are not divided after the last one that was; 0 if it was spread
    uint32_t undivided;     ///< how many of them are left
    mspringi_progress *counters;
};

/* ------------------------------------------------------------------------------------------------ lifecycle */

static mspring_result check_host(const mspring_tasks **given, mspring_tasks *host, mspringi_message *message) {
    mspring_result result = mspringi_take_tasks(message, given, host);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_tasks", host->reserved);
    if (result != MSPRING_OK)
        return result;
    if (!host->run)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "mspring_tasks.run is NULL");
    if (host->concurrent_count < 1 || host->concurrent_count > host->worker_count)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "mspring_tasks.concurrent_count is %u, it must be 1 to worker_count, which is %u",
                             (unsigned)host->concurrent_count, (unsigned)host->worker_count);
    return MSPRING_OK;
}

static mspring_result make_counters(mspringi_tasks *tasks, mspringi_memory *memory, mspringi_message *message) {
    tasks->counters = mspringi_alloc(memory, tasks->concurrency, sizeof *tasks->counters);
    if (!tasks->counters)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u workers",
                             (unsigned)tasks->worker_count);
    for (; tasks->counter_count < tasks->concurrency; ++tasks->counter_count)
        if (!mspringi_progress_init(&tasks->counters[tasks->counter_count]))
            return mspringi_fail(message, MSPRING_ERROR_THREAD, "the system has no lock for worker %u",
                                 (unsigned)tasks->counter_count);
    return MSPRING_OK;
}

mspring_result mspringi_tasks_create(uint32_t worker_count, const mspring_tasks *host, mspringi_memory *memory,
                                     mspringi_message *message, mspringi_tasks **tasks) {
    mspring_tasks taken;
    if (host) {
        mspring_result result = check_host(&host, &taken, message);
        if (result != MSPRING_OK)
            return result;
        worker_count = host->worker_count;
    }
    if (worker_count < 1 || worker_count > MSPRING_MAX_WORKERS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "worker_count is %u, it must be 1 to %u",
                             (unsigned)worker_count, (unsigned)MSPRING_MAX_WORKERS);
#if !defined(MSPRINGI_THREADS)
    worker_count = 1;
#endif
    if (worker_count == 1) {
        *tasks = NULL;
        return MSPRING_OK;
    }
    mspringi_tasks *created = mspringi_alloc(memory, 1, sizeof *created);
    if (!created)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u workers", (unsigned)worker_count);
    if (host)
        created->host = *host;
    created->worker_count = worker_count;
    created->concurrency = host ? host->concurrent_count : worker_count;
    mspring_result result = make_counters(created, memory, message);
    if (result == MSPRING_OK && !host)
        result = mspringi_pool_create(worker_count, memory, message, &created->pool);
    if (result == MSPRING_OK)
        *tasks = created;
    else
        mspringi_tasks_destroy(created, memory);
    return result;
}

void mspringi_tasks_destroy(mspringi_tasks *tasks, mspringi_memory *memory) {
    if (!tasks)
        return;
    mspringi_pool_destroy(tasks->pool, memory);
    for (uint32_t i = 0; i < tasks->counter_count; ++i)
        mspringi_progress_destroy(&tasks->counters[i]);
    mspringi_free(memory, tasks->counters);
    mspringi_free(memory, tasks);
}

mspring_result mspringi_tasks_restart_after_fork(mspringi_tasks *tasks, mspringi_message *message) {
    return tasks && tasks->pool ? mspringi_pool_restart_after_fork(tasks->pool, message) : MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------- running */

typedef struct task_body {
    mspring_task_fn fn;
    void *argument;
    uint32_t takers[MSPRING_MAX_WORKERS]; ///< of the first bodies
} task_body;

// Run a body in the floating-point environment of a step; its thread may have any other.
static void run_body(void *argument, uint32_t index, uint32_t worker) {
    task_body *body = argument;
    const mspringi_fp_state before = mspringi_fp_enter();
    if (index < MSPRING_MAX_WORKERS)
        body->takers[index] = worker;
    body->fn(body->argument, index, worker);
    mspringi_fp_leave(before);
}

#if defined(MSPRINGI_THREADS)
uint32_t mspringi_tasks_workers(const mspringi_tasks *tasks) {
    return tasks ? tasks->worker_count : 1;
}
#endif

uint32_t mspringi_tasks_concurrency(const mspringi_tasks *tasks) {
    return tasks ? tasks->concurrency : 1;
}

bool mspringi_tasks_are_independent(const mspringi_tasks *tasks) {
    return tasks && tasks->concurrency == 1;
}

uint32_t mspringi_tasks_partition_size(const mspringi_tasks *tasks) {
    return mspringi_tasks_are_independent(tasks) ? tasks->worker_count : mspringi_tasks_concurrency(tasks);
}

mspringi_progress *mspringi_tasks_progress(mspringi_tasks *tasks) {
    return tasks ? tasks->counters : NULL;
}

uint32_t mspringi_tasks_sleeps(const mspringi_tasks *tasks) {
    uint32_t sleeps = 0;
    for (uint32_t i = 0; tasks && i < tasks->counter_count; ++i)
        sleeps += mspringi_progress_sleeps(&tasks->counters[i]);
    return sleeps;
}

static bool is_spread(const task_body *body, uint32_t count) {
    for (uint32_t i = 1; i < count && i < MSPRING_MAX_WORKERS; ++i)
        if (body->takers[i] != body->takers[0])
            return true;
    return false;
}

void mspringi_tasks_run(mspringi_tasks *tasks, uint32_t count, mspring_task_fn fn, void *argument) {
    task_body body;
    body.fn = fn;
    body.argument = argument;
    if (!tasks || count <= 1) {
        for (uint32_t index = 0; index < count; ++index)
            run_body(&body, index, 0);
        return;
    }
    for (uint32_t i = 0; i < tasks->counter_count; ++i)
        mspringi_progress_reset(&tasks->counters[i], 0);
    if (tasks->pool)
        mspringi_pool_run(tasks->pool, count, run_body, &body);
    else
        tasks->host.run(count, run_body, &body, tasks->host.user);
    tasks->was_divided = true;
    tasks->was_spread = tasks->was_spread || is_spread(&body, count);
}

bool mspringi_tasks_are_in_turn(const mspringi_tasks *tasks) {
    return tasks && tasks->undivided > 0;
}

void mspringi_tasks_judge(mspringi_tasks *tasks) {
    if (!mspringi_tasks_are_independent(tasks))
        return;
    const uint32_t longer = tasks->patience > 0 ? 2 * tasks->patience : SHORTEST_PATIENCE;
    if (tasks->undivided > 0) {
        tasks->undivided--;
    } else if (tasks->was_divided) {
        tasks->patience = tasks->was_spread ? 0 : longer < LONGEST_PATIENCE ? longer : LONGEST_PATIENCE;
        tasks->undivided = tasks->patience;
    }
    tasks->was_divided = tasks->was_spread = false;
}

/// Shortest range worth a worker.
#define MIN_RANGE 16384

typedef struct ranges {
    size_t count, length;
    mspringi_range_fn fn;
    void *argument;
} ranges;

static void run_range(void *argument, uint32_t index, uint32_t worker) {
    const ranges *all = argument;
    (void)worker;
    const size_t first = index * all->length, left = all->count - first;
    all->fn(all->argument, first, first + (left < all->length ? left : all->length));
}

void mspringi_tasks_run_ranges(mspringi_tasks *tasks, size_t count, size_t grain, mspringi_range_fn fn,
                               void *argument) {
    const size_t workers = mspringi_tasks_workers(tasks);
    if (workers == 1 || count < 2 * MIN_RANGE) {
        fn(argument, 0, count);
        return;
    }
    const size_t equal = (count + workers - 1) / workers, length = equal > MIN_RANGE ? equal : MIN_RANGE;
    ranges all = {.count = count, .length = (length + grain - 1) / grain * grain, .fn = fn, .argument = argument};
    mspringi_tasks_run(tasks, (uint32_t)((count + all.length - 1) / all.length), run_range, &all);
}
