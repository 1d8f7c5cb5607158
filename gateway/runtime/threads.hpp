// Names and scheduling of the program's threads. Each function is called by a thread about itself; requests that the system refuses are
// ignored.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>

namespace axisgate {

/// Name of the calling thread (15 characters at most), and an increase of the nice value with which the process was started, so that on a
/// busy machine the page or the database never delays a machine.
inline void enter_thread(const char* name, int nice_by) noexcept {
    pthread_setname_np(pthread_self(), name);
    if (nice_by > 0)
        (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())) + nice_by);
}
/// True if this thread was given a real-time policy from outside, which is kept.
inline bool ranked_from_outside() noexcept { return (sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) != SCHED_OTHER; }
/// Requests to run before every thread of the normal policy, in turn with others of this real-time rank, if the system grants it
/// (RLIMIT_RTPRIO, systemd's LimitRTPRIO=2). Only for threads that sleep: one that spins would keep its processor. Returns false if
/// refused.
inline bool go_first(int rank = 1) noexcept {
    if (ranked_from_outside()) return true;
    sched_param p{};
    p.sched_priority = rank;
    return sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &p) == 0;
}
/// Ends the rank of go_first.
inline void go_with_others() noexcept {
    const sched_param p{};
    (void)sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &p);
}
/// Requests short turns on the processor. Since Linux 6.12 a waking thread with a shorter slice runs before one with a longer slice;
/// without it a thread with a nice value only may first end its own slice of some milliseconds. Earlier kernels ignore it; no privilege is
/// needed (sched_setattr(2): sched_runtime of a thread of the normal policy, 0.1 to 100 ms).
inline constexpr std::uint64_t hot_turn_ns = 100'000, warm_turn_ns = 300'000, cold_turn_ns = 100'000;
inline void take_short_turns(std::uint64_t turn_ns) noexcept {
    struct Attributes {  // struct sched_attr, first published form: the C library has no name for it
        std::uint32_t size = 48, policy = SCHED_OTHER;
        std::uint64_t flags = 0;
        std::int32_t nice = 0;
        std::uint32_t priority = 0;
        std::uint64_t runtime_ns = 0, deadline_ns = 0, period_ns = 0;
    } a;
    static_assert(sizeof(Attributes) == 48);
    a.runtime_ns = turn_ns;
    a.flags = (sched_getscheduler(0) & SCHED_RESET_ON_FORK) != 0 ? 1 : 0;  // a flag that is set stays, because clearing it needs a
                                                                           // privilege
    a.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
    if (!ranked_from_outside()) (void)syscall(SYS_sched_setattr, 0, &a, 0U);  // a real-time policy given from outside stays
}
/// Processor time of this thread since it began.
inline std::int64_t used_of_processor_ns() noexcept {
    timespec used{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return used.tv_sec * std::int64_t{1'000'000'000} + used.tv_nsec;
}
/// Gives way to others if this thread has used its processor for `piece_ns` since the last time. Must be called between small pieces of
/// work: a waking thread of the normal policy runs before a running one only if it has not had more than its share, and the kernel checks
/// this at its next tick, 1 to 4 ms later.
inline void give_way_after(std::int64_t piece_ns) noexcept {
    static thread_local std::int64_t given_way_ns = 0;
    const std::int64_t used_ns = used_of_processor_ns();
    if (used_ns - given_way_ns < piece_ns) return;
    given_way_ns = used_ns;
    (void)sched_yield();
}
inline constexpr std::int64_t cold_piece_ns = 50'000;
inline constexpr int hot_rank = 2, warm_rank = 1;
inline constexpr int hot_stands_back = 0;
inline constexpr int warm_stands_back = 5;  ///< if the hot thread has no rank of its own
inline constexpr int cold_stands_back = 10;
/// Nice value of the thread that computes password hashes: a person waits for it, and on a busy machine a thread at +10 has a fortieth of a
/// processor, while a hash takes 0.1 s of one.
inline constexpr int secret_stands_back = 2;

}  // namespace axisgate
