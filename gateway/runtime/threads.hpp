// Threads: how the three threads of the program name themselves and stand back for one another.
// In: called by a thread about itself. Out: its name and its rank. Never fails: what the system does not grant is left as it is.
#pragma once

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

namespace axisgate {

/// Name of the calling thread (15 characters at most), and its nice value: the hot thread keeps what the process was started with, the
/// others stand back, so that on a busy machine a page or a database never makes a machine wait.
inline void enter_thread(const char* name, int nice_by) noexcept {
    pthread_setname_np(pthread_self(), name);
    if (nice_by > 0) (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())) + nice_by);
}
inline constexpr int hot_stands_back = 0;
inline constexpr int warm_stands_back = 5;
inline constexpr int cold_stands_back = 10;

}  // namespace axisgate
