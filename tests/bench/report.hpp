// The output of benchmarks: one line with the ratio, its limit and both figures, in the form that tests/bench/run.sh counts. Figures
// without a limit are only shown.
#pragma once

#include <cstdio>

namespace axisgate::bench {

/// `ratio` is `ours` / `theirs` or the reverse, as `what` says. Returns whether the limit is kept.
inline bool say(const char* what, double ratio, const char* relation, double limit, const char* our_name, double ours,
                const char* their_name, double theirs, const char* unit) {
    const bool kept = relation[0] == '>' ? ratio >= limit : ratio <= limit;
    std::printf("    %-34s ratio %10.3f  limit %s %.10g  %-8s  %s %.4g %s, %s %.4g %s\n", what, ratio, relation, limit,
                kept ? "kept" : "NOT KEPT", our_name, ours, unit, their_name, theirs, unit);
    std::fflush(stdout);
    return kept;
}

}  // namespace axisgate::bench
