// On a byte line everything that the drive sends keeps its order, because it is one stream; on CAN a frame that the drive sends by itself
// is not held back by an answer that is still prepared.
#include "gateway/wire/specimen_twin.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace {

struct Manners {
    explicit Manners(const TwinSetup& setup)
        : seed(setup.seed),
          reply(ms(setup, common_freedom::reply_ms)),
          spread(ms(setup, common_freedom::reply_spread_ms)),
          late(ms(setup, common_freedom::late_ms)),
          chunk_pause(ms(setup, common_freedom::chunk_pause_ms)),
          boot(ms(setup, common_freedom::boot_ms)),
          flash(ms(setup, common_freedom::flash_silence_ms)),
          late_share(freedom(setup.freedoms, common_freedom::late_per_mille)),
          doubled_share(freedom(setup.freedoms, common_freedom::doubled_per_mille)),
          lost_share(freedom(setup.freedoms, common_freedom::lost_per_mille)),
          noise_share(freedom(setup.freedoms, common_freedom::noise_per_mille)),
          chunk(static_cast<std::size_t>(freedom(setup.freedoms, common_freedom::chunk_bytes))) {}

    [[nodiscard]] bool none() const noexcept {
        constexpr auto zero = Duration::zero();
        return reply == zero && spread == zero && boot == zero && flash == zero && (late == zero || late_share == 0) &&
               doubled_share == 0 && lost_share == 0 && noise_share == 0 && chunk == 0;
    }

    /// Nothing holds an answer back, cuts it or has bytes before it.
    [[nodiscard]] bool undelayed() const noexcept {
        constexpr auto zero = Duration::zero();
        return reply == zero && spread == zero && (late == zero || late_share == 0) && chunk == 0 && noise_share == 0;
    }

    std::uint64_t seed;
    Duration reply, spread, late, chunk_pause, boot, flash;
    std::int64_t late_share, doubled_share, lost_share, noise_share;
    std::size_t chunk;

private:
    static Duration ms(const TwinSetup& setup, std::string_view name) { return std::chrono::milliseconds(freedom(setup.freedoms, name)); }
};

/// Frames that wait, in order of time and of arrival. Their memory is kept for the next ones, because most drives send one answer at a
/// time, and in order.
class WaitingFrames {
public:
    struct Waiting {
        Instant at{};
        Out::Tx tx;
    };
    [[nodiscard]] bool empty() const noexcept { return first_ == all_.size(); }
    [[nodiscard]] std::size_t size() const noexcept { return all_.size() - first_; }
    [[nodiscard]] const Waiting& front() const noexcept { return all_[first_]; }
    [[nodiscard]] auto begin() noexcept { return all_.begin() + static_cast<std::ptrdiff_t>(first_); }
    [[nodiscard]] auto end() noexcept { return all_.end(); }
    void clear() noexcept {
        all_.clear();
        first_ = 0;
    }
    void pop_front() noexcept {
        if (++first_ == all_.size()) clear();
    }
    void put(const Out::Tx& tx, Instant at) {
        if (first_ > 0 && first_ >= size()) {  // as many places are empty as are taken
            all_.erase(all_.begin(), begin());
            first_ = 0;
        }
        auto place = end();
        if (!empty() && all_.back().at > at)
            place = std::upper_bound(begin(), end(), at, [](Instant t, const Waiting& w) { return t < w.at; });
        Waiting& w = place == end() ? all_.emplace_back() : *all_.emplace(place);
        w.at = at;
        w.tx = tx;
    }

private:
    std::vector<Waiting> all_;
    std::size_t first_ = 0;  ///< those before it have left
};

class SpecimenTwin final : public Twin {
public:
    SpecimenTwin(std::unique_ptr<Twin> twin, const TwinSetup& setup)
        : twin_(std::move(twin)), manners_(setup), falls_silent_(manners_.flash != Duration::zero()) {}

    void on_frame(const Frame& frame, Instant now, Out& out) override {
        run(now, out);
        if (boots()) return;
        if (writes_at_once()) {
            const std::size_t first = out.frames.size();
            twin_->on_frame(frame, now, out);
            due_known_ = false;
            answer_at_once(out, first);
            return;
        }
        const std::uint64_t before = falls_silent_ ? twin_->non_volatile_revision() : 0;
        own_.frames.clear();
        twin_->on_frame(frame, now, own_);
        due_known_ = false;
        answer(own_, now);
        // A change that no request made (a tester's hand, the place of an absolute encoder) is no write of a flash memory.
        if (falls_silent_ && twin_->non_volatile_revision() != before) fall_silent(now);
        send_due(now, out);
    }
    [[nodiscard]] Acceptance acceptance() const noexcept override { return twin_->acceptance(); }
    void on_deadline(Instant now, Out& out) override { run(now, out); }
    [[nodiscard]] Instant deadline() const override {
        if (boots()) return boot_end_;
        due_known_ = false;
        return std::min({due(), switch_on_at_, waiting_.empty() ? never : waiting_.front().at});
    }

    void power_on(const NonVolatile& memory, Instant now, Out& out) override {
        waiting_.clear();
        silent_until_ = stream_free_ = now;
        switch_on_at_ = never;
        boot_end_ = now + manners_.boot;
        memory_ = memory;
        run(now, out);
    }
    [[nodiscard]] NonVolatile non_volatile() const override { return boots() ? *memory_ : twin_->non_volatile(); }
    [[nodiscard]] bool fit_axes(int axes, Instant now) override {
        due_known_ = false;
        return twin_->fit_axes(axes, now);
    }
    [[nodiscard]] std::uint64_t non_volatile_revision() const override { return twin_->non_volatile_revision(); }
    [[nodiscard]] std::vector<HandItem> hand() const override {
        std::vector<HandItem> items = twin_->hand();
        if (!boots() && switch_on_at_ == never) return items;
        for (HandItem& item : items)
            if (item.name == "power") item.value = Value{true};  // it has its supply, and boots
        return items;
    }
    [[nodiscard]] std::string set_hand(const std::string& name, const Value& value, Instant now, Out& out) override {
        run(now, out);
        if (boots()) wait_switched_off(now);
        if (name == "power" && manners_.boot != Duration::zero()) {
            const auto on = as_flag(value);
            if (on && *on && switch_on_at_ != never) return {};
            if (on && *on && !powered()) return switch_on_at_ = now + manners_.boot, std::string();
            if (on) switch_on_at_ = never;
        }
        if (name == "power" && as_flag(value) == false) waiting_.clear();
        Out own;
        std::string fault = twin_->set_hand(name, value, now, own);
        due_known_ = false;
        keep(own, now);
        send_due(now, out);
        return fault;
    }
    [[nodiscard]] TwinMechanics mechanics(int channel, Instant now) const override { return twin_->mechanics(channel, now); }

private:
    /// Limit of frames that wait to be sent; further ones are lost, as in a drive whose buffer is full.
    static constexpr std::size_t most_waiting = 1024;
    [[nodiscard]] std::uint64_t place(std::string_view of) const noexcept { return specimen_place(manners_.seed, of); }
    [[nodiscard]] bool boots() const noexcept { return memory_.has_value(); }
    /// The twin's own deadline, as of the last question for a deadline or the last call that may have changed it.
    [[nodiscard]] Instant due() const {
        if (!due_known_) due_ = twin_->deadline();
        due_known_ = true;
        return due_;
    }
    /// Its answers leave the drive as the twin gives them, but for single ones that are lost or doubled.
    [[nodiscard]] bool writes_at_once() const noexcept { return manners_.undelayed() && !falls_silent_ && waiting_.empty(); }

    [[nodiscard]] bool powered() const {
        for (const HandItem& item : twin_->hand()) {
            if (item.name == "power") return as_integer(item.value).value_or(1) != 0;
        }
        return true;
    }

    void finish_boot(Instant now, Out& own) {
        const NonVolatile memory = std::move(*memory_);
        memory_.reset();
        twin_->power_on(memory, now, own);
        due_known_ = false;
    }
    /// The hand sets conditions of a drive that still boots: the twin gets its memory now, and its power when the boot is over.
    void wait_switched_off(Instant now) {
        Out unsent;
        finish_boot(now, unsent);
        if (twin_->set_hand("power", Value{false}, now, unsent).empty()) switch_on_at_ = boot_end_;
        due_known_ = false;
    }

    /// Everything of the drive's own that is due by `now`, each at its instant.
    void run(Instant now, Out& out) {
        if (boots() && boot_end_ <= now) {
            Out own;
            finish_boot(boot_end_, own);
            keep(own, now);
        }
        if (switch_on_at_ <= now) {
            Out own;
            (void)twin_->set_hand("power", Value{true}, std::exchange(switch_on_at_, never), own);
            due_known_ = false;
            keep(own, now);
        }
        if (!boots() && due() <= now) {
            own_.frames.clear();
            twin_->on_deadline(now, own_);
            due_known_ = false;
            keep(own_, now);
        }
        send_due(now, out);
    }

    [[nodiscard]] bool happens(std::uint64_t place, std::int64_t share) const {
        return share > 0 && static_cast<std::int64_t>(specimen_draw_at(place, messages_) % 1000) < share;
    }
    [[nodiscard]] Duration spread() const {
        if (manners_.spread == Duration::zero()) return {};
        return Duration(
            static_cast<std::int64_t>(specimen_draw_at(spread_, messages_) % static_cast<std::uint64_t>(manners_.spread.count() + 1)));
    }

    /// As `answer` for a drive whose answers do not wait; those from `first` on are new.
    void answer_at_once(Out& out, std::size_t first) {
        auto& frames = out.frames;
        for (std::size_t i = first; i < frames.size();) {
            ++messages_;
            if (happens(lost_, manners_.lost_share)) {
                frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(i));
                continue;
            }
            ++i;
            if (!happens(doubled_, manners_.doubled_share)) continue;
            const Out::Tx again = frames[i - 1];
            frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(i), again);
            ++i;
        }
    }
    /// Frames that the twin sent as an answer.
    void answer(const Out& own, Instant now) {
        for (const auto& tx : own.frames) {
            ++messages_;
            if (happens(lost_, manners_.lost_share)) continue;
            Instant at = std::max(now, tx.frame.at) + manners_.reply + spread();
            if (happens(late_, manners_.late_share)) at += manners_.late;
            put(tx, at);
            if (happens(doubled_, manners_.doubled_share)) put(tx, at);
        }
    }
    /// Frames that it sends by itself. Those of the lowest priority are no answers: on a byte line they are left out while the line is
    /// busy.
    void keep(const Out& own, Instant now) {
        for (const auto& tx : own.frames) {
            ++messages_;
            const Instant at = std::max(now, tx.frame.at);
            const bool waits_for_the_line = tx.priority == Priority::poll && tx.frame.kind == Frame::Kind::bytes;
            if (!waits_for_the_line || std::max(stream_free_, silent_until_) <= at) put(tx, at);
        }
    }

    void put(const Out::Tx& tx, Instant at) {
        at = std::max(at, silent_until_);
        const bool bytes = tx.frame.kind == Frame::Kind::bytes;
        if (!bytes) return insert(tx, at);
        at = std::max(at, stream_free_);
        if (happens(noise_, manners_.noise_share)) {
            Out::Tx wrong = tx;
            const std::uint8_t byte = static_cast<std::uint8_t>(specimen_draw(manners_.seed, "wrong byte", messages_));
            wrong.frame.assign({&byte, 1});
            insert(wrong, at);
        }
        const std::size_t run = manners_.chunk == 0 ? Frame::capacity : manners_.chunk;
        for (auto rest = tx.frame.data(); !rest.empty(); rest = rest.subspan(std::min(run, rest.size()))) {
            Out::Tx part = tx;
            part.frame.assign(rest.first(std::min(run, rest.size())));
            insert(part, at);
            if (rest.size() > run) at += manners_.chunk_pause;
        }
        stream_free_ = at;
    }
    void insert(const Out::Tx& tx, Instant at) {
        if (waiting_.size() >= most_waiting) return;
        waiting_.put(tx, at);
    }

    /// The memory is written: nothing leaves the drive, its answer to the write included.
    void fall_silent(Instant now) {
        if (manners_.flash == Duration::zero()) return;
        silent_until_ = now + manners_.flash;
        for (WaitingFrames::Waiting& w : waiting_)
            w.at = std::max(w.at, silent_until_);
        stream_free_ = std::max(stream_free_, silent_until_);
    }
    void send_due(Instant now, Out& out) {
        while (!waiting_.empty() && waiting_.front().at <= now) {
            out.frames.push_back(waiting_.front().tx);
            out.frames.back().frame.at = waiting_.front().at;
            waiting_.pop_front();
        }
    }

    std::unique_ptr<Twin> twin_;
    Manners manners_;
    bool falls_silent_;
    std::uint64_t lost_ = place("lost"), late_ = place("late"), doubled_ = place("doubled"), noise_ = place("noise"),
                  spread_ = place("spread");
    Out own_;  ///< of a call of the twin
    mutable Instant due_ = never;
    mutable bool due_known_ = false;
    WaitingFrames waiting_;
    std::optional<NonVolatile> memory_;  ///< while it boots: the memory with which it will be switched on
    Instant boot_end_{}, silent_until_{}, stream_free_{};
    Instant switch_on_at_ = never;  ///< end of a boot after the hand has given power
    std::uint64_t messages_ = 0;
};

}  // namespace

std::unique_ptr<Twin> with_common_freedoms(std::unique_ptr<Twin> twin, const TwinSetup& setup) {
    if (Manners(setup).none()) return twin;
    return std::make_unique<SpecimenTwin>(std::move(twin), setup);
}

void specimen_setup(const Catalogue& page, TwinSetup& setup) {
    setup.freedoms = freedoms_of(page, setup.options);
    const auto specimen = setup.options.find("specimen");
    setup.seed = specimen_draw(0, specimen == setup.options.end() ? "0" : specimen->second);
    for (const char c : setup.address)
        setup.seed = specimen_draw(setup.seed, std::string_view(&c, 1));  // drives of one line are not late at the same instants
}

std::unique_ptr<Twin> make_specimen(const Family& family, const Catalogue& page, TwinSetup setup) {
    specimen_setup(page, setup);
    return with_common_freedoms(family.make_twin(page, setup), setup);
}

}  // namespace axisgate
