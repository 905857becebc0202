// Runs tasks, which may add further tasks, on a few threads. Independent of trees.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "base/threads.h"

namespace candela {

// Tasks are taken newest first, which keeps the number of waiting ones small.
template <class Task>
class TaskQueue {
  public:
    // Adds a task; a task that runs may call this.
    void push(Task task) {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(task));
        changed_.notify_one();
    }

    // Calls work(task) for every task, on `threads` (>= 1) threads including the caller's, or on fewer if no
    // more can be started, until no task is left. The first exception that `work` throws ends the run and is
    // rethrown.
    template <class Work>
    void run(unsigned threads, const Work& work) {
        std::vector<JoiningThread> helpers = start_helpers(threads - 1, [&] { serve(work); });
        serve(work);
        helpers.clear();  // Joins.
        if (error_) std::rethrow_exception(error_);
    }

  private:
    template <class Work>
    void serve(const Work& work) {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return !waiting_.empty() || running_ == 0 || error_; });
            if (waiting_.empty() || error_) break;
            const Task task = std::move(waiting_.back());
            waiting_.pop_back();
            ++running_;
            lock.unlock();
            std::exception_ptr error;
            try {
                work(task);
            } catch (...) {
                error = std::current_exception();
            }
            lock.lock();
            --running_;
            if (error && !error_) error_ = error;
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Task> waiting_;
    size_t running_ = 0;  // Tasks that threads work on now.
    std::exception_ptr error_;
};

}  // namespace candela
