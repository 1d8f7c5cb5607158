// Report: how benchmarks say what they measured: one line with the ratio, the limit it is measured against, and both figures.
// In: figures. Out: text on standard output, in the form that tests/bench/run.sh counts. Never judges by itself what is not limited.
#pragma once

#include <cstdio>

namespace axisgate::bench {

/// `ratio` = `ours` / `theirs` or the other way round, as `what` says. Returns whether the limit is kept.
inline bool say(const char* what, double ratio, const char* relation, double limit, const char* our_name, double ours,
                const char* their_name, double theirs, const char* unit) {
    const bool kept = relation[0] == '>' ? ratio >= limit : ratio <= limit;
    std::printf("    %-34s ratio %10.3f  limit %s %.10g  %-8s  %s %.4g %s, %s %.4g %s\n", what, ratio, relation, limit,
                kept ? "kept" : "NOT KEPT", our_name, ours, unit, their_name, theirs, unit);
    std::fflush(stdout);
    return kept;
}

}  // namespace axisgate::bench
