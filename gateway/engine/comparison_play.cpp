// Plays a recording to twins in virtual time, and makes messages of frames. Both sides use a decoder of their own, which also reads the
// requests, because some sentences depend on the request before them.
#include <algorithm>
#include <optional>

#include "gateway/engine/comparison_parts.hpp"
#include "gateway/wire/specimen_twin.hpp"

namespace axisgate::comparison {
namespace {
using namespace std::chrono_literals;

/// The twins are switched on this long before the recording, and the recording is continued for `tail`, so that late answers are seen.
constexpr Duration before = 5s, tail = 5s;
/// A message of a twin behind a request is its answer within this time.
constexpr Duration longest_answer = 1s;
/// Limit of deadlines of one twin between two frames: a twin that stays due must not stop the time.
constexpr std::size_t least_deadlines = 200'000, deadlines_per_frame = 50;
/// Messages of the twin in one play.
constexpr std::size_t most_emitted = 2 * ComparisonInput::most_frames;

std::uint32_t stream_of(const Frame& f) noexcept {
    return f.kind == Frame::Kind::bytes ? 0 : f.id | (f.extended ? 0x80000000u : 0) | (f.remote ? 0x40000000u : 0);
}

struct Emitted {
    Frame frame;
    std::size_t cause = none;
    bool prompt = false;
};

class Player {
public:
    Player(const ComparisonInput& input, const std::string& specimen, const Disturbance& disturbance)
        : input_(input), disturbance_(disturbance), deadlines_(least_deadlines + deadlines_per_frame * input.frames.size()) {
        for (const auto& address : input.addresses)
            twins_.push_back(make_twin(input, address, specimen));
    }

    Play run() {
        switch_on();
        std::size_t request = none;
        for (const ComparedFrame& f : input_.frames) {
            const Instant at = shifted(f.frame.at);
            run_until(at, request);
            if (!f.to_drive) continue;
            if (!f.foreign) ++request;  // none + 1 is 0
            give(f.frame, at, request);
        }
        run_until(input_.frames.empty() ? first : shifted(input_.frames.back().frame.at) + tail, request);
        return finish();
    }

private:
    /// The twins' time of the first frame.
    static constexpr Instant first = time_zero + 1000s;

    [[nodiscard]] Instant shifted(Instant at) const {
        const Duration since = at - time_zero;
        return first + (disturbance_.time == 1
                            ? since
                            : Duration(static_cast<std::int64_t>(static_cast<double>(since.count()) * disturbance_.time)));
    }

    void switch_on() {
        for (std::size_t i = 0; i < twins_.size(); ++i) {
            const auto memory = input_.memories.find(input_.addresses[i]);
            twins_[i]->power_on(memory == input_.memories.end() ? NonVolatile{} : memory->second, first - before, out_);
            if (disturbance_.position != 0)  // families without this hand refuse it
                (void)twins_[i]->set_hand("position", Value{disturbance_.position}, first - before, out_);
            take(first - before, none, false);
        }
        run_until(first - Duration(1), none);
        emitted_.clear();
        revision_ = revision();
        play_.memory_writes.clear();
    }

    void run_until(Instant now, std::size_t request) {
        for (auto& twin : twins_) {
            Instant at{};
            while (twin->deadline() <= now) {
                const bool spent = deadlines_ == 0;
                at = spent ? now : std::max(twin->deadline(), at + 1us);
                if (at > now) break;
                twin->on_deadline(at, out_);
                take(at, request, answers_late(at));
                if (spent) break;
                --deadlines_;
            }
        }
    }

    /// On a byte line many twins send their answer with the pace of their port, and not from within the call that has the request.
    [[nodiscard]] bool answers_late(Instant at) const noexcept {
        return input_.kind == LineKind::bytes && open_request_ && at - *open_request_ <= longest_answer;
    }

    void give(const Frame& frame, Instant at, std::size_t request) {
        const std::size_t before_it = emitted_.size();
        Frame f = frame;
        f.at = at;
        for (auto& twin : twins_) {
            if (f.kind == Frame::Kind::can && !twin->acceptance().takes(f.id)) continue;
            twin->on_frame(f, at, out_);
            take(at, request, true);
        }
        open_request_ = emitted_.size() == before_it ? std::optional(at) : std::nullopt;
        if (const std::uint64_t now = revision(); now != revision_) {
            revision_ = now;
            play_.memory_writes.push_back(time_zero + (at - first));
        }
    }

    void take(Instant now, std::size_t cause, bool prompt) {
        for (const auto& tx : out_.frames) {
            if (emitted_.size() == most_emitted) break;
            emitted_.push_back({tx.frame, cause, prompt});
            emitted_.back().frame.at = time_zero + (std::max(now, tx.frame.at) - first);
        }
        out_.clear();
    }

    [[nodiscard]] std::uint64_t revision() const {
        std::uint64_t sum = 0;
        for (const auto& twin : twins_)
            sum += twin->non_volatile_revision();
        return sum;
    }

    Play finish() {
        std::ranges::stable_sort(emitted_, {}, [](const Emitted& e) { return e.frame.at; });
        const auto decoder = input_.family->make_decoder(*input_.page, input_.kind);
        std::size_t next = 0, request = none;
        const auto read_requests = [&](auto&& before_answer) {
            for (; next < input_.frames.size(); ++next) {
                const ComparedFrame& f = input_.frames[next];
                if (!f.to_drive || f.foreign) continue;
                if (!before_answer(request + 1, f.frame.at)) return;
                ++request;
                (void)decoder->on_frame(f.frame, true);
            }
        };
        for (const Emitted& e : emitted_) {
            read_requests([&](std::size_t number, Instant at) { return (e.cause != none && number <= e.cause) || at < e.frame.at; });
            for (auto& text : decoder->on_frame(e.frame, false))
                play_.messages.push_back({e.frame.at, e.cause, e.prompt, stream_of(e.frame), e.frame.size, std::move(text)});
        }
        return std::move(play_);
    }

    const ComparisonInput& input_;
    Disturbance disturbance_;
    std::vector<std::unique_ptr<Twin>> twins_;
    Out out_;
    std::vector<Emitted> emitted_;
    std::size_t deadlines_;  ///< that are left: behind them the twin passes each gap of the recording in one step
    std::uint64_t revision_ = 0;
    std::optional<Instant> open_request_;  ///< the last frame to the twins, if none of them answered it at once
    Play play_;
};
}  // namespace

std::unique_ptr<Twin> make_twin(const ComparisonInput& input, const std::string& address, const std::string& specimen) {
    TwinSetup setup;
    setup.address = address;
    setup.axes = 16;  // as many channels as the family has
    setup.kind = input.kind;
    setup.bit_rate = input.bit_rate;
    setup.options = input.options;
    setup.options["specimen"] = specimen;
    specimen_setup(*input.page, setup);
    return input.family->make_twin(*input.page, setup);
}

Requests requests_of(const ComparisonInput& input) {
    Requests out;
    const auto decoder = input.family->make_decoder(*input.page, input.kind);
    for (std::size_t i = 0; i < input.frames.size(); ++i) {
        const ComparedFrame& f = input.frames[i];
        if (f.foreign) continue;
        std::string text;
        for (const auto& line : decoder->on_frame(f.frame, f.to_drive))
            text += (text.empty() ? "" : " | ") + line;
        if (!f.to_drive) continue;
        out.frames.push_back(i);
        out.at.push_back(f.frame.at);
        out.text.push_back(std::move(text));
    }
    return out;
}

std::vector<Message> recorded_messages(const ComparisonInput& input) {
    std::vector<Message> out;
    const auto decoder = input.family->make_decoder(*input.page, input.kind);
    std::size_t request = none;
    for (const ComparedFrame& f : input.frames) {
        if (f.foreign) continue;
        if (f.to_drive) ++request;
        for (auto& text : decoder->on_frame(f.frame, f.to_drive)) {
            if (!f.to_drive) out.push_back({f.frame.at, request, false, stream_of(f.frame), f.frame.size, std::move(text)});
        }
    }
    return out;
}

Play play(const ComparisonInput& input, const std::string& specimen, const Disturbance& disturbance) {
    return Player(input, specimen, disturbance).run();
}

}  // namespace axisgate::comparison
