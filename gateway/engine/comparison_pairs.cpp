// Pairs the messages of a drive with those of its twin, the surest pairs first: the same sentence at the expected time, then the same
// sentence behind the same request, then behind a later request (a late answer), then messages of the same form, and messages that both
// sent by themselves. The expected time comes first, because a gateway that gets no answer in time repeats the request, and then the
// nearest request is not the one that was answered.
#include <algorithm>
#include <unordered_map>

#include "gateway/engine/comparison_parts.hpp"

namespace axisgate::comparison {
namespace {
using namespace std::chrono_literals;

/// An answer is looked for behind this many later requests, and for this time.
constexpr std::size_t most_requests_later = 16;
constexpr Duration most_late = 5s;
/// Messages that are sent by themselves belong together within this time.
constexpr Duration by_itself = 2s;

enum class Alike : std::uint8_t { text, form, any };

class Pairing {
public:
    Pairing(const Requests& requests, const std::vector<Message>& recorded, const std::vector<Message>& twin, const ReplyRange& range)
        : requests_(requests),
          recorded_(recorded),
          twin_(twin),
          range_(range),
          to_twin_(recorded.size(), none),
          to_recorded_(twin.size(), none) {
        for (std::size_t i = 0; i < twin.size(); ++i) {
            by_cause_[place(twin[i].stream, twin[i].cause)].push_back(i);
            by_stream_[twin[i].stream].push_back(i);
        }
    }

    std::vector<Pair> run() {
        pass([&](std::size_t r) { return in_time(r); });
        pass([&](std::size_t r) { return behind_same(r, Alike::text); });
        pass([&](std::size_t r) { return behind_earlier(r, Alike::text); });
        pass([&](std::size_t r) { return behind_same(r, Alike::form); });
        pass([&](std::size_t r) { return near(r, Alike::text); });
        pass([&](std::size_t r) { return behind_earlier(r, Alike::form); });
        pass([&](std::size_t r) { return behind_same(r, Alike::any); });
        pass([&](std::size_t r) { return near(r, Alike::form); });
        std::vector<Pair> out;
        for (std::size_t r = 0; r < recorded_.size(); ++r)
            out.push_back({r, to_twin_[r]});
        for (std::size_t t = 0; t < twin_.size(); ++t)
            if (to_recorded_[t] == none) out.push_back({none, t});
        std::ranges::stable_sort(out, {}, [&](const Pair& p) { return p.recorded != none ? recorded_[p.recorded].at : twin_[p.twin].at; });
        return out;
    }

private:
    static std::uint64_t place(std::uint32_t stream, std::size_t cause) noexcept {
        return static_cast<std::uint64_t>(stream) << 32 ^ static_cast<std::uint64_t>(cause + 1);
    }

    template <class F>
    void pass(F&& find) {
        for (std::size_t r = 0; r < recorded_.size(); ++r) {
            if (to_twin_[r] != none) continue;
            if (const std::size_t t = find(r); t != none) {
                to_twin_[r] = t;
                to_recorded_[t] = r;
            }
        }
    }

    [[nodiscard]] bool alike(std::size_t r, std::size_t t, Alike how) {
        if (to_recorded_[t] != none) return false;
        if (how == Alike::any) return true;
        return how == Alike::text ? recorded_[r].text == twin_[t].text : form(recorded_[r].text) == form(twin_[t].text);
    }
    /// The form of a sentence; many sentences are equal, so it is kept.
    const std::string& form(const std::string& text) {
        auto& kept = forms_[text];
        if (kept.empty()) kept = shape_of(text).text + ' ';
        return kept;
    }

    std::size_t first_alike(const std::vector<std::size_t>& candidates, std::size_t r, Alike how) {
        for (const std::size_t t : candidates)
            if (alike(r, t, how)) return t;
        return none;
    }

    std::size_t behind_same(std::size_t r, Alike how) {
        const auto it = by_cause_.find(place(recorded_[r].stream, recorded_[r].cause));
        return it == by_cause_.end() ? none : first_alike(it->second, r, how);
    }

    /// The oldest request whose answer may come at this time.
    std::size_t in_time(std::size_t r) {
        const Message& m = recorded_[r];
        if (m.cause == none) return none;
        for (std::size_t cause = m.cause - std::min(m.cause, most_requests_later); cause <= m.cause; ++cause) {
            const auto it = by_cause_.find(place(m.stream, cause));
            if (it == by_cause_.end()) continue;
            for (const std::size_t t : it->second) {
                const Duration after = m.at - twin_[t].at;
                if (twin_[t].prompt && after >= range_.least && after <= range_.most && alike(r, t, Alike::text)) return t;
            }
        }
        return none;
    }

    std::size_t behind_earlier(std::size_t r, Alike how) {
        const Message& m = recorded_[r];
        if (m.cause == none || m.cause == 0) return none;
        for (std::size_t cause = m.cause - std::min(m.cause, most_requests_later); cause < m.cause; ++cause) {
            if (m.at - requests_.at[cause] > most_late) continue;
            const auto it = by_cause_.find(place(m.stream, cause));
            if (it == by_cause_.end()) continue;
            for (const std::size_t t : it->second)
                if (twin_[t].prompt && alike(r, t, how)) return t;
        }
        return none;
    }

    /// The nearest one in time that the twin sent by itself.
    std::size_t near(std::size_t r, Alike how) {
        const auto it = by_stream_.find(recorded_[r].stream);
        if (it == by_stream_.end()) return none;
        const Instant at = recorded_[r].at;
        const auto begin = std::ranges::lower_bound(it->second, at - by_itself, {}, [&](std::size_t t) { return twin_[t].at; });
        std::size_t best = none;
        for (auto t = begin; t != it->second.end() && twin_[*t].at <= at + by_itself; ++t) {
            if (twin_[*t].prompt || !alike(r, *t, how)) continue;
            if (best == none || abs(twin_[*t].at - at) < abs(twin_[best].at - at)) best = *t;
        }
        return best;
    }

    const Requests& requests_;
    const std::vector<Message>&recorded_, &twin_;
    ReplyRange range_;
    std::vector<std::size_t> to_twin_, to_recorded_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_cause_;
    std::unordered_map<std::uint32_t, std::vector<std::size_t>> by_stream_;
    std::unordered_map<std::string, std::string> forms_;
};
}  // namespace

std::vector<Pair> pair_messages(const Requests& requests, const std::vector<Message>& recorded, const std::vector<Message>& twin,
                                const ReplyRange& range) {
    return Pairing(requests, recorded, twin, range).run();
}

}  // namespace axisgate::comparison
