#include "tasks/pool.h"

#if defined(MSPRINGI_THREADS)

#include "base/assert.h"
#include "tasks/progress.h"

typedef struct pool_worker {
    mspringi_progress started;  ///< runs started for this worker so far
    mspringi_progress finished; ///< runs that it has finished
    uint32_t start_count;       ///< value of started, for the calling thread
    uint32_t number;
    bool has_counters, has_thread;
    mspringi_pool *pool;
    mspringi_thread thread;
    mspringi_thread_start start;
} pool_worker;

struct mspringi_pool {
    uint64_t process; ///< process that owns the threads
    uint32_t worker_count, count;
    mspring_task_fn fn; ///< NULL ends the worker
    void *argument;
    pool_worker *workers; ///< worker 0, the caller, has no counters and no thread
};

static void run_share(const mspringi_pool *pool, uint32_t worker) {
    for (uint32_t index = worker; index < pool->count; index += pool->worker_count)
        pool->fn(pool->argument, index, worker);
}

static void thread_main(void *argument) {
    pool_worker *self = argument;
    for (uint32_t call = 1;; ++call) {
        mspringi_progress_wait(&self->started, call);
        if (!self->pool->fn)
            return;
        run_share(self->pool, self->number);
        mspringi_progress_advance(&self->finished, call);
    }
}

static bool start_worker(pool_worker *worker) {
    if (!mspringi_progress_init(&worker->started))
        return false;
    if (!mspringi_progress_init(&worker->finished)) {
        mspringi_progress_destroy(&worker->started);
        return false;
    }
    worker->has_counters = true;
    worker->start = (mspringi_thread_start){thread_main, worker};
    worker->has_thread = mspringi_thread_create(&worker->thread, &worker->start);
    return worker->has_thread;
}

static mspring_result start_workers(mspringi_pool *pool, mspringi_message *message) {
    pool->process = mspringi_process();
    for (uint32_t w = 1; w < pool->worker_count; ++w) {
        pool_worker *worker = &pool->workers[w];
        *worker = (pool_worker){.pool = pool, .number = w};
        if (!start_worker(worker))
            return mspringi_fail(message, MSPRING_ERROR_THREAD,
                                 "the system has no thread for worker %u (of %u: 0 to %u)", (unsigned)w,
                                 (unsigned)pool->worker_count, (unsigned)(pool->worker_count - 1));
    }
    return MSPRING_OK;
}

static void end_workers(mspringi_pool *pool) {
    pool->fn = NULL;
    for (uint32_t w = 1; w < pool->worker_count; ++w)
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): without workers their number is 0
        if (pool->workers[w].has_thread)
            mspringi_progress_advance(&pool->workers[w].started, ++pool->workers[w].start_count);
    for (uint32_t w = 1; w < pool->worker_count; ++w) {
        pool_worker *worker = &pool->workers[w];
        if (worker->has_thread)
            mspringi_thread_join(worker->thread);
        if (worker->has_counters) {
            mspringi_progress_destroy(&worker->started);
            mspringi_progress_destroy(&worker->finished);
        }
        worker->has_thread = worker->has_counters = false;
    }
}

mspring_result mspringi_pool_create(uint32_t worker_count, mspringi_memory *memory, mspringi_message *message,
                                    mspringi_pool **pool) {
    mspringi_pool *created = mspringi_alloc(memory, 1, sizeof *created);
    if (created)
        created->workers = mspringi_alloc(memory, worker_count, sizeof *created->workers);
    if (!created || !created->workers) {
        mspringi_pool_destroy(created, memory);
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u workers", (unsigned)worker_count);
    }
    created->worker_count = worker_count;
    const mspring_result result = start_workers(created, message);
    if (result == MSPRING_OK)
        *pool = created;
    else
        mspringi_pool_destroy(created, memory);
    return result;
}

// After a fork, locks and conditions that the parent's threads wait on can be neither used nor destroyed. So the
// child initialises them again in place.
mspring_result mspringi_pool_restart_after_fork(mspringi_pool *pool, mspringi_message *message) {
    const uint64_t before = pool->process;
    if (before == mspringi_process())
        return MSPRING_OK;
    for (uint32_t w = 1; w < pool->worker_count; ++w)
        pool->workers[w].has_thread = pool->workers[w].has_counters = false;
    const mspring_result result = start_workers(pool, message);
    if (result != MSPRING_OK) {
        end_workers(pool);
        pool->process = before;
    }
    return result;
}

void mspringi_pool_destroy(mspringi_pool *pool, mspringi_memory *memory) {
    if (!pool)
        return;
    if (pool->process == mspringi_process())
        end_workers(pool);
    mspringi_free(memory, pool->workers);
    mspringi_free(memory, pool);
}

void mspringi_pool_run(mspringi_pool *pool, uint32_t count, mspring_task_fn fn, void *argument) {
    const uint32_t active = count < pool->worker_count ? count : pool->worker_count;
    MSPRINGI_ASSERT(pool->process == mspringi_process());
    pool->count = count;
    pool->fn = fn;
    pool->argument = argument;
    for (uint32_t w = 1; w < active; ++w)
        mspringi_progress_advance(&pool->workers[w].started, ++pool->workers[w].start_count);
    run_share(pool, 0);
    for (uint32_t w = 1; w < active; ++w)
        mspringi_progress_wait(&pool->workers[w].finished, pool->workers[w].start_count);
}

#else

// Never called: mspringi_tasks_create() makes a pool only if there are threads.

mspring_result mspringi_pool_create(uint32_t worker_count, mspringi_memory *memory, mspringi_message *message,
                                    mspringi_pool **pool) {
    (void)worker_count, (void)memory, (void)pool;
    return mspringi_fail(message, MSPRING_ERROR_THREAD, "this build of the library has no threads");
}

mspring_result mspringi_pool_restart_after_fork(mspringi_pool *pool, mspringi_message *message) {
    (void)pool, (void)message;
    return MSPRING_OK;
}

void mspringi_pool_destroy(mspringi_pool *pool, mspringi_memory *memory) {
    (void)pool, (void)memory;
}

void mspringi_pool_run(mspringi_pool *pool, uint32_t count, mspring_task_fn fn, void *argument) {
    (void)pool;
    for (uint32_t index = 0; index < count; ++index)
        fn(argument, index, 0);
}

#endif
