// Threads: how the three threads of the program name themselves and stand back for one another.
// In: called by a thread about itself. Out: its name and its rank. Never fails: what the system does not grant is left as it is.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>

namespace axisgate {

/// Name of the calling thread (15 characters at most), and what is added to the nice value that the process was started with: those that
/// stand back do so for the hot thread, so that on a busy machine a page or a database never makes a machine wait.
inline void enter_thread(const char* name, int nice_by) noexcept {
    pthread_setname_np(pthread_self(), name);
    if (nice_by > 0)
        (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())) + nice_by);
}
/// Whether a real-time policy was given to this thread from outside: it stays as it is.
inline bool ranked_from_outside() noexcept { return (sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) != SCHED_OTHER; }
/// Asks to go before every thread of the normal policy, in turn with others of this real-time rank, where the system grants that
/// (RLIMIT_RTPRIO, systemd's LimitRTPRIO=2). Only for a thread that sleeps: one that spins would keep its processor for itself. False: not
/// granted.
inline bool go_first(int rank = 1) noexcept {
    if (ranked_from_outside()) return true;
    sched_param p{};
    p.sched_priority = rank;
    return sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &p) == 0;
}
/// Takes the rank of go_first back.
inline void go_with_others() noexcept {
    const sched_param p{};
    (void)sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &p);
}
/// Asks for short turns on the processor. Linux since 6.12 lets a waking thread with a shorter slice in before one with a longer one;
/// without it a thread that only stands back by nice may still end its own slice of some milliseconds first. Earlier kernels ignore it; it
/// needs no privilege (sched_setattr(2): sched_runtime of a thread of the normal policy, 0.1 to 100 ms).
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
    a.flags = (sched_getscheduler(0) & SCHED_RESET_ON_FORK) != 0 ? 1 : 0;  // what is set stays: to take it back needs a privilege
    a.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
    if (!ranked_from_outside()) (void)syscall(SYS_sched_setattr, 0, &a, 0U);  // a real-time policy given from outside stays
}
/// What this thread has used of its processor since it began.
inline std::int64_t used_of_processor_ns() noexcept {
    timespec used{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return used.tv_sec * std::int64_t{1'000'000'000} + used.tv_nsec;
}
/// Lets others in if this thread has used its processor for `piece_ns` since it last did. To be called between small pieces of work. A
/// waking thread of the normal policy only comes before a running one if it has not had more than its share, and the kernel looks again no
/// sooner than at its next tick, 1 to 4 ms later.
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
inline constexpr int warm_stands_back = 5;  ///< where the hot thread has no rank of its own
inline constexpr int cold_stands_back = 10;
/// Of the thread that computes passwords' hashes: a person waits for it, and on a busy machine a thread at +10 has a fortieth of a
/// processor; a hash takes 0.1 s of one.
inline constexpr int secret_stands_back = 2;

}  // namespace axisgate
