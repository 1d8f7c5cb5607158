// Judges the pairs of messages for each specimen, and finds the specimen with the fewest differences. The freedoms that all families share
// are judged as ranges: a reply time may be anywhere in the specimen's range, and of its late, lost and doubled answers the share counts.
#include "gateway/engine/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "gateway/core/specimen.hpp"
#include "gateway/engine/comparison_parts.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate {
using namespace comparison;
namespace {

/// What the common freedoms of a specimen permit.
struct Allowance {
    explicit Allowance(const FreedomValues& f)
        : least(ms(f, common_freedom::reply_ms)),
          most(least + ms(f, common_freedom::reply_spread_ms)),
          late(ms(f, common_freedom::late_ms)),
          flash(ms(f, common_freedom::flash_silence_ms)),
          pause(ms(f, common_freedom::chunk_pause_ms)),
          chunk(freedom(f, common_freedom::chunk_bytes)),
          late_share(freedom(f, common_freedom::late_per_mille)),
          lost_share(freedom(f, common_freedom::lost_per_mille)),
          doubled_share(freedom(f, common_freedom::doubled_per_mille)),
          noise_share(freedom(f, common_freedom::noise_per_mille)) {}

    Duration least, most, late, flash, pause;
    std::int64_t chunk, late_share, lost_share, doubled_share, noise_share;

    /// A share that was drawn is not met exactly.
    static bool within(std::size_t count, std::int64_t share, std::size_t of) noexcept {
        return share > 0 && static_cast<double>(count) <= 2.0 * static_cast<double>(share) / 1000.0 * static_cast<double>(of) + 3;
    }

private:
    static Duration ms(const FreedomValues& f, std::string_view name) { return std::chrono::milliseconds(freedom(f, name)); }
};

/// A difference, and its name that is the same for all specimens.
struct Found {
    std::uint64_t key = 0;
    Difference difference;
};

struct Verdict {
    SpecimenScore score;
    std::vector<Found> found;
    std::size_t equal = 0;
    std::vector<Duration> replies;
    std::map<std::string, MeasuredDifference> measured;
    std::vector<std::pair<std::size_t, std::size_t>> answers;  ///< recorded and twin's message of each prompt pair
    std::vector<Message> twin;
};

class Judge {
public:
    Judge(const ComparisonInput& input, const Requests& requests, const std::vector<Message>& recorded, const Measured& measured)
        : input_(input), requests_(requests), recorded_(recorded), measured_(measured) {
        if (!input.frames.empty()) end_ = input.frames.back().frame.at;
    }

    Verdict judge(const std::string& specimen) {
        std::map<std::string, std::string> options = input_.options;
        options["specimen"] = specimen;
        const FreedomValues freedoms = freedoms_of(*input_.page, options);
        const Allowance allowed(freedoms);
        Play played = play(input_, specimen);
        Verdict v;
        v.score.specimen = specimen;
        for (const Freedom& f : input_.page->freedoms())
            if (freedom(freedoms, f.name, f.fallback) != f.fallback) ++v.score.freedoms;
        v.twin = std::move(played.messages);
        writes_ = std::move(played.memory_writes);
        const ReplyRange range{allowed.least - input_.tolerance, allowed.most + input_.tolerance};
        judge_pairs(v, pair_messages(requests_, recorded_, v.twin, range), allowed);
        take_shares(v, allowed);
        count(v);
        return v;
    }

private:
    enum Group : std::uint64_t { of_message = 1, of_time = 2, of_twin = 3 };
    static std::uint64_t key(Group group, std::uint64_t number, std::uint64_t more = 0) noexcept {
        return static_cast<std::uint64_t>(group) << 60 ^ number << 20 ^ more;
    }
    [[nodiscard]] std::string request_of(std::size_t cause) const {
        for (std::size_t i = cause; i != none && i < requests_.text.size(); --i)
            if (!requests_.text[i].empty()) return requests_.text[i];
        return {};
    }

    void judge_pairs(Verdict& v, const std::vector<Pair>& pairs, const Allowance& allowed) {
        const auto [first, last] = own_rhythm(v, pairs);
        std::map<std::uint64_t, std::uint64_t> ordinals;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Pair& p = pairs[i];
            if (p.recorded != none && p.twin != none) {
                judge_pair(v, p, allowed);
            } else if (p.recorded != none) {
                const Message& m = recorded_[p.recorded];
                if (i < first_of(first, m.stream) || i > last_of(last, m.stream)) continue;
                Difference d{.kind = Difference::Kind::extra, .at = m.at, .request = request_of(m.cause), .recorded = m.text};
                v.found.push_back({key(of_message, p.recorded), std::move(d)});
            } else {
                const Message& m = v.twin[p.twin];
                const std::uint64_t ordinal = ordinals[key(of_twin, m.cause + 1, m.stream)]++;
                if (unseen(m, allowed) || i < first_of(first, m.stream) || i > last_of(last, m.stream)) continue;
                const bool asked = m.prompt && m.cause != none;
                Difference d{.kind = Difference::Kind::missing,
                             .at = asked ? requests_.at[m.cause] : m.at,
                             .request = asked ? request_of(m.cause) : std::string(),
                             .twin = m.text};
                v.found.push_back({key(of_twin, (m.cause + 1) << 4 ^ ordinal, m.stream), std::move(d)});
            }
        }
    }

    /// The first and last pair of each stream of messages that both send by themselves (heartbeats): at the edges of the recording one more
    /// or less is a matter of phase.
    using Edges = std::unordered_map<std::uint32_t, std::size_t>;
    std::pair<Edges, Edges> own_rhythm(const Verdict& v, const std::vector<Pair>& pairs) const {
        Edges first, last;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (pairs[i].recorded == none || pairs[i].twin == none || v.twin[pairs[i].twin].prompt) continue;
            first.try_emplace(v.twin[pairs[i].twin].stream, i);
            last[v.twin[pairs[i].twin].stream] = i;
        }
        for (const Message& m : v.twin) {
            if (!m.prompt) continue;
            first.erase(m.stream);
            last.erase(m.stream);
        }
        return {std::move(first), std::move(last)};
    }
    static std::size_t first_of(const Edges& e, std::uint32_t stream) {
        const auto it = e.find(stream);
        return it == e.end() ? 0 : it->second;
    }
    static std::size_t last_of(const Edges& e, std::uint32_t stream) {
        const auto it = e.find(stream);
        return it == e.end() ? none : it->second;
    }

    /// The recording ended before the drive had to send this message.
    [[nodiscard]] bool unseen(const Message& m, const Allowance& allowed) const {
        return m.at + allowed.most + (allowed.late_share > 0 ? allowed.late : Duration::zero()) + wire_time(m, allowed) + input_.tolerance >
               end_;
    }
    [[nodiscard]] Duration wire_time(const Message& m, const Allowance& allowed) const {
        if (input_.kind != LineKind::bytes) return Duration::zero();
        Duration d = input_.bit_rate == 0 ? Duration::zero() : Duration(std::int64_t{1'000'000'000} * 10 * m.size / input_.bit_rate);
        if (allowed.chunk > 0) d += allowed.pause * (m.size / allowed.chunk);
        return d;
    }

    void judge_pair(Verdict& v, const Pair& p, const Allowance& allowed) {
        const Message &r = recorded_[p.recorded], &t = v.twin[p.twin];
        const bool answer = t.prompt && t.cause != none;
        const std::size_t cause = answer ? std::min(r.cause, t.cause) : r.cause;
        const std::string request = answer ? request_of(cause) : std::string();
        if (answer) v.answers.emplace_back(p.recorded, p.twin);
        if (r.text == t.text) {
            ++v.equal;
        } else if (double largest = 0; measured_.only(requests_, r, t, largest)) {
            note_measured(v, r, t, request, largest);
        } else {
            Difference d{.kind = Difference::Kind::value, .at = r.at, .request = request, .recorded = r.text, .twin = t.text};
            v.found.push_back({key(of_message, p.recorded), std::move(d)});
        }
        if (answer) judge_time(v, p, cause, request, allowed);
    }

    void note_measured(Verdict& v, const Message& r, const Message& t, const std::string& request, double largest) {
        ++v.equal;
        // The encoder's own flicker and rounding are not worth a line; other words are (largest is 0 then).
        if (largest != 0 && largest <= 1) return;
        MeasuredDifference& m = v.measured[request.empty() ? shape_of(r.text).text : shape_of(request).text];
        ++m.answers;
        if (m.answers > 1 && largest <= m.largest) return;
        m.request = request;
        m.recorded = r.text;
        m.twin = t.text;
        m.at = r.at;
        m.largest = largest;
    }

    void judge_time(Verdict& v, const Pair& p, std::size_t cause, const std::string& request, const Allowance& allowed) {
        const Message &r = recorded_[p.recorded], &t = v.twin[p.twin];
        const Duration reply = r.at - requests_.at[cause], own = std::max(Duration::zero(), t.at - requests_.at[t.cause]);
        v.replies.push_back(reply);
        const Duration least = own + allowed.least;
        Duration most = own + allowed.most + wire_time(t, allowed);
        if (allowed.flash != Duration::zero()) {
            const auto write = std::ranges::upper_bound(writes_, requests_.at[cause]);
            if (write != writes_.begin() && requests_.at[cause] - *(write - 1) <= allowed.flash) most += allowed.flash;
        }
        if (reply >= least - input_.tolerance && reply <= most + input_.tolerance) return;
        Difference d{.kind = reply > most ? Difference::Kind::late : Difference::Kind::early,
                     .at = r.at,
                     .request = request,
                     .recorded = r.text,
                     .twin = t.text};
        d.reply = reply;
        d.least = least;
        d.most = most;
        v.found.push_back({key(of_time, p.recorded), std::move(d)});
    }

    /// Differences that the specimen makes with a certain frequency are none, as long as they are not more frequent.
    void take_shares(Verdict& v, const Allowance& allowed) const {
        const std::size_t all = v.answers.size();
        const auto take = [&](std::int64_t share, auto&& is) {
            const auto count = static_cast<std::size_t>(std::ranges::count_if(v.found, is));
            if (count != 0 && Allowance::within(count, share, all)) std::erase_if(v.found, is);
        };
        take(allowed.lost_share,
             [](const Found& f) { return f.difference.kind == Difference::Kind::missing && !f.difference.request.empty(); });
        take(allowed.noise_share, [](const Found& f) {
            return f.difference.kind == Difference::Kind::extra && f.difference.recorded.find("unknown") != std::string::npos;
        });
        take(allowed.late_share, [&](const Found& f) {
            return f.difference.kind == Difference::Kind::late && f.difference.reply <= f.difference.most + allowed.late + input_.tolerance;
        });
        const auto doubled = [&](const Found& f) {
            if (f.difference.kind != Difference::Kind::extra) return false;
            const auto later = std::ranges::lower_bound(recorded_, f.difference.at, {}, &Message::at);
            for (auto m = later; m != recorded_.begin();)
                if ((--m)->text == f.difference.recorded)
                    return f.difference.at - m->at <= std::chrono::milliseconds(100);
                else if (f.difference.at - m->at > std::chrono::milliseconds(100))
                    return false;
            return false;
        };
        take(allowed.doubled_share, doubled);
    }

    static void count(Verdict& v) {
        for (const Found& f : v.found) {
            switch (f.difference.kind) {
                case Difference::Kind::value:
                    ++v.score.values;
                    break;
                case Difference::Kind::missing:
                    ++v.score.missing;
                    break;
                case Difference::Kind::extra:
                    ++v.score.extra;
                    break;
                case Difference::Kind::late:
                case Difference::Kind::early:
                    ++v.score.times;
                    break;
            }
        }
    }

    const ComparisonInput& input_;
    const Requests& requests_;
    const std::vector<Message>& recorded_;
    const Measured& measured_;
    std::vector<Instant> writes_;
    Instant end_{};
};

/// Answers to the same request that change for good, while those of the twin do not.
std::vector<RecordedChange> changes_in(const Requests& requests, const std::vector<Message>& recorded, const Verdict& v) {
    struct Course {
        std::string_view first, second, twin;
        Instant at{};
        std::size_t later = 0;
        bool steady = true;
    };
    std::map<std::pair<std::uint32_t, std::string_view>, Course> courses;
    for (const auto& [r, t] : v.answers) {
        const Message &was = recorded[r], &twin = v.twin[t];
        const std::string_view request = requests.text[twin.cause];
        if (request.empty()) continue;
        const auto [it, fresh] = courses.try_emplace({twin.stream, request}, Course{was.text, {}, twin.text, {}});
        Course& c = it->second;
        if (fresh) continue;
        c.steady = c.steady && twin.text == c.twin;
        if (was.text == c.first && c.second.empty()) continue;
        if (c.second.empty()) {
            c.second = was.text;
            c.at = was.at;
        }
        c.steady = c.steady && was.text == c.second;
        ++c.later;
    }
    std::vector<RecordedChange> out;
    for (const auto& [place, c] : courses)
        if (c.steady && c.later >= 2) out.push_back({c.at, std::string(place.second), std::string(c.first), std::string(c.second)});
    std::ranges::sort(out, {}, &RecordedChange::at);
    return out;
}

/// What is known of the recording before a specimen is tried.
std::string unusable(const ComparisonInput& input, const Requests& requests, const std::vector<Message>& recorded) {
    std::string at;
    for (const auto& a : input.addresses)
        at += (at.empty() ? "" : ", ") + a;
    if (requests.frames.empty())
        return fmt::format("the recording has no message to a drive of {} at address {}: name its address", input.family->name, at);
    if (recorded.empty())
        return fmt::format("the recording has no message from a drive of {} at address {}: name its address", input.family->name, at);
    return {};
}

void explain(Comparison& out, const Verdict& best, const std::vector<std::pair<std::string, std::vector<std::uint64_t>>>& keys) {
    constexpr std::size_t most_named = 5;
    for (const Found& f : best.found) {
        Difference d = f.difference;
        for (const auto& [specimen, has] : keys) {
            if (d.explained_by.size() == most_named) break;
            if (!std::ranges::binary_search(has, f.key)) d.explained_by.push_back(specimen);
        }
        out.differences.push_back(std::move(d));
    }
    std::ranges::stable_sort(out.differences, {}, &Difference::at);
}

void take_replies(Comparison& out, std::vector<Duration> replies) {
    if (replies.empty()) return;
    std::ranges::sort(replies);
    out.shortest_reply = replies.front();
    out.median_reply = replies[replies.size() / 2];
    out.longest_reply = replies.back();
}

Measured learned(const ComparisonInput& input, const Requests& requests) {
    Measured measured(*input.page);
    const std::string specimen = input.specimens.empty() ? "0" : input.specimens.front();
    const auto undisturbed = play(input, specimen).messages;
    // The pace is quicker, because a slower one would let time-outs of the drive pass. The distance changes all four bytes of a position.
    for (const Disturbance& d : {Disturbance{.time = 0.87}, Disturbance{.position = 16'909'060}, Disturbance{.position = -98'765}})
        measured.learn(requests, undisturbed, play(input, specimen, d).messages);
    return measured;
}
}  // namespace

std::string_view name_of(Difference::Kind kind) noexcept {
    switch (kind) {
        case Difference::Kind::value:
            return "value";
        case Difference::Kind::missing:
            return "missing";
        case Difference::Kind::extra:
            return "extra";
        case Difference::Kind::late:
            return "late";
        case Difference::Kind::early:
            return "early";
    }
    return "unknown";
}

std::size_t Comparison::unexplained() const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(differences, [](const Difference& d) { return d.explained_by.empty(); }));
}

Comparison compare(const ComparisonInput& input) {
    Comparison out;
    const Requests requests = requests_of(input);
    const std::vector<Message> recorded = recorded_messages(input);
    out.requests = requests.frames.size();
    out.answers = recorded.size();
    if (!input.frames.empty()) out.span = input.frames.back().frame.at - input.frames.front().frame.at;
    out.fault = unusable(input, requests, recorded);
    if (!out.fault.empty()) return out;
    const Measured measured = learned(input, requests);
    Judge judge(input, requests, recorded, measured);
    std::optional<Verdict> best;
    std::vector<std::pair<std::string, std::vector<std::uint64_t>>> keys;
    for (const auto& specimen : input.specimens) {
        Verdict v = judge.judge(specimen);
        auto& of = keys.emplace_back(specimen, std::vector<std::uint64_t>()).second;
        for (const Found& f : v.found)
            of.push_back(f.key);
        std::ranges::sort(of);
        out.scores.push_back(v.score);
        const auto rank = [](const SpecimenScore& s) { return std::pair(s.differences(), s.freedoms); };
        if (!best || rank(v.score) < rank(best->score)) best = std::move(v);
    }
    if (!best) return out;
    std::ranges::stable_sort(out.scores, {}, [](const SpecimenScore& s) { return std::pair(s.differences(), s.freedoms); });
    out.equal = best->equal;
    if (out.equal == 0 && out.answers >= 3) {
        out.fault = fmt::format(
            "none of the {} messages of the drive is one that a drive of {} sends: the recording is of another family or "
            "of another address",
            out.answers, input.family->name);
        return out;
    }
    std::map<std::string, std::string> options = input.options;
    options["specimen"] = best->score.specimen;
    out.best_in_words = specimen_in_words(*input.page, freedoms_of(*input.page, options));
    explain(out, *best, keys);
    take_replies(out, best->replies);
    for (auto& [request, m] : best->measured)
        out.measured.push_back(std::move(m));
    out.changes = changes_in(requests, recorded, *best);
    return out;
}

}  // namespace axisgate
