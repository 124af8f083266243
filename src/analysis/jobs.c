/// Calls for jobs that make another layout while the network goes on.
#include "base/cpu.h"
#include "network/job.h"

mspring_result mspring_job_begin(mspring_network *network, mspring_layout layout, mspring_job **job) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!job || (layout != MSPRING_LAYOUT_COMPACT && layout != MSPRING_LAYOUT_WHOLE))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the job is NULL, or layout %d is unknown",
                             (int)layout);
    if (network->job)
        return mspringi_fail(&network->message, MSPRING_ERROR_BUSY, "the network has a job that is not finished");
    result = mspringi_job_begin(network, layout, job);
    if (result == MSPRING_OK) {
        (*job)->network = network;
        network->job = *job;
    }
    return result;
}

mspring_result mspring_job_run(mspring_job *job, uint32_t at_most, uint32_t *left) {
    if (!job)
        return MSPRING_ERROR_ARGUMENT;
    if (job->failure != MSPRING_OK) // keep the message of the failure
        return MSPRING_ERROR_ARGUMENT;
    if (job->is_spent)
        return mspringi_fail(&job->to.message, MSPRING_ERROR_ARGUMENT, "the job is finished: destroy it");
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = mspringi_job_run(job, at_most);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && left)
        *left = mspringi_job_left(job);
    return result;
}

const char *mspring_job_error(const mspring_job *job) {
    return job ? job->to.message.text : "";
}

mspring_result mspring_job_finish(mspring_network *network, mspring_job *job) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (job && job->failure != MSPRING_OK) {
        network->message = job->to.message;
        return job->failure;
    }
    if (!job || job->is_spent)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the job is NULL or is finished");
    if (job->network && job->network != network)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the job was begun for another network");
    if (mspringi_job_left(job) > 0)
        return mspringi_fail(&network->message, MSPRING_ERROR_BUSY, "the job has not been run to its end");
    if (!job->network)
        return mspringi_fail(&network->message, MSPRING_ERROR_OUTDATED,
                             "the layout has changed since the job began: begin another job");
    mspringi_job_invalidate(network);
    const mspringi_fp_state before = mspringi_fp_enter();
    result = mspringi_job_finish(network, job);
    mspringi_fp_leave(before);
    return result;
}

void mspring_job_destroy(mspring_job *job) {
    mspringi_job_destroy(job);
}
