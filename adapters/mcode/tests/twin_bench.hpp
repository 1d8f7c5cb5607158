// Bench for the language of the MCode twin: one drive in virtual time with a plain motor (constant speed VM, MT + HT to settle).
// In: lines as a host types them. Out: the bytes that the drive sent, control characters as <NAME>.
// Never tests motion: the motor's own tests do; this one knows just enough for programs to wait for.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "adapters/mcode/twin/device.hpp"

namespace axisgate::mcode::twin::test {

using std::chrono::milliseconds;

class PlainMotor final : public Mechanism {
public:
    PlainMotor() { factory({}); }
    void restart(Instant now) override {
        stop_at_once(now);
        from_ = to_ = 0;
        began_ = ended_ = now;
        events.clear();
    }
    void factory(Instant) override {
        values = {{Word::A, 1000000}, {Word::D, 1000000}, {Word::VI, 1000}, {Word::VM, 768000}, {Word::MS, 256}, {Word::DE, 1},
                  {Word::MT, 500},    {Word::HT, 500},    {Word::RC, 25},   {Word::HC, 5},      {Word::C1, 0},   {Word::C2, 0},
                  {Word::ST, 0},      {Word::I1, 0},      {Word::IN, 0},    {Word::I5, 0},      {Word::AF, 0},   {Word::FS, 0}};
    }
    void save(NonVolatile& m) const override {
        for (const auto& [w, v] : values)
            m[std::string(text_of(w))] = Value{static_cast<std::int64_t>(v)};
    }
    void load(const NonVolatile& m, Instant) override {
        for (auto& [w, v] : values) {
            if (const auto it = m.find(std::string(text_of(w))); it != m.end()) v = as_number(it->second).value_or(v);
        }
    }
    Number read(Word w, Instant now, int& error) override {
        if (w == Word::P) return Number::of(std::llround(position(now)));
        if (w == Word::V) return Number::of(now < ended_ ? std::llround(speed()) : 0);
        if (w == Word::MV || w == Word::MP) return Number::of(moving(now) ? 1 : 0);
        if (const auto it = values.find(w); it != values.end()) return Number::of(static_cast<std::int64_t>(it->second));
        if (info(w).access == Access::none) error = 35;
        return Number::of(0);
    }
    std::optional<std::string> text(Word w, Instant) override {
        if (w == Word::MD) return std::string(text_of(last_));
        if (w == Word::IT) return "25, 26";
        if (w == Word::VT) return "0, 24, 48";
        return std::nullopt;
    }
    int write(Word w, std::span<const Number> f, Instant now) override {
        if (w == Word::P) {
            const double shift = f[0].as_double() - position(now);
            from_ += shift;
            to_ += shift;
            return 0;
        }
        values[w] = f[0].as_double();
        return 0;
    }
    int start(Word w, std::span<const Number> f, Instant now) override {
        if (values[Word::DE] == 0) return 94;
        const double here = position(now);
        last_ = w;
        slewing_ = w == Word::SL && f[0].truth();
        from_ = here;
        began_ = now;
        if (w == Word::MA) to_ = f[0].as_double();
        if (w == Word::MR) to_ = here + f[0].as_double();
        if (w == Word::SL) to_ = slewing_ ? here + (f[0].as_double() > 0 ? 1e12 : -1e12) : here;
        rate_ = slewing_ ? std::abs(f[0].as_double()) : values[Word::VM];
        const double seconds = std::abs(to_ - here) / rate_;
        ended_ = now + Duration{static_cast<std::int64_t>(seconds * 1e9)};
        finished_reported_ = false;
        return 0;
    }
    int arm(Word w, std::span<const Number> f, Instant) override {
        if (w == Word::TC) return 12;
        if (w == Word::TP) trip_position_ = f[0].as_double();
        return 0;
    }
    void enable_trips(int te, Instant) override { te_seen = te; }
    void capture(Instant now) override { values[Word::PC] = position(now); }
    void stop_at_once(Instant now) override {
        from_ = to_ = position(now);
        began_ = ended_ = now;
        finished_reported_ = true;
        slewing_ = false;
        ++stops;
    }
    void pause(Instant) override { ++pauses; }
    void resume(Instant) override { ++resumes; }
    bool moving(Instant now) override { return now < settled(); }
    bool busy(bool any, Instant now) override { return moving(now) && (any || !slewing_); }
    void tell(bool, bool, Instant) override {}
    void advance(Instant now) override {
        if ((te_seen & 2) != 0 && now >= crossing()) events.push_back({MotorEvent::Kind::trip, 0, Word::TP});
        if (!finished_reported_ && now >= settled()) {
            finished_reported_ = true;
            events.push_back({MotorEvent::Kind::finished, 0, {}});
        }
    }
    Instant deadline() const override {
        Instant t = finished_reported_ ? never : settled();
        if ((te_seen & 2) != 0) t = std::min(t, crossing());
        return t;
    }
    std::optional<MotorEvent> next_event() override {
        if (events.empty()) return std::nullopt;
        const MotorEvent e = events.front();
        events.pop_front();
        return e;
    }
    std::vector<HandItem> hand(Instant) const override { return {{"stall", false, true, "held"}}; }
    std::optional<std::string> set_hand(const std::string& n, const Value&, Instant) override {
        return n == "stall" ? std::optional<std::string>("") : std::nullopt;
    }
    TwinMechanics mechanics(Instant now) const override { return {position(now), 0, true}; }

    std::map<Word, double> values;
    std::deque<MotorEvent> events;
    int te_seen = 0, stops = 0, pauses = 0, resumes = 0;

private:
    double speed() const { return to_ < from_ ? -rate_ : rate_; }
    double position(Instant now) const {
        if (now >= ended_) return to_;
        return from_ + speed() * seconds(now - began_);
    }
    static double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
    Instant settled() const { return began_ == ended_ && to_ == from_ ? ended_ : ended_ + milliseconds(1000); }
    Instant crossing() const {
        const double d = (trip_position_ - from_) / speed();
        if (began_ == ended_ || d < 0 || (to_ - from_) / speed() < d) return never;
        return began_ + Duration{static_cast<std::int64_t>(d * 1e9) + 1};
    }
    Word last_ = Word::MR;
    double from_ = 0, to_ = 0, rate_ = 1, trip_position_ = 0;
    bool slewing_ = false, finished_reported_ = true;
    Instant began_{}, ended_{};
};

inline std::string shown(std::string_view bytes) {
    std::string s;
    for (const char c : bytes) {
        const auto b = static_cast<std::uint8_t>(c);
        if (b == '\r') {
            s += "<CR>";
        } else if (b == '\n') {
            s += "<LF>";
        } else if (b == 6) {
            s += "<ACK>";
        } else if (b == 21) {
            s += "<NAK>";
        } else if (b < 32 || b > 126) {
            char hex[8];
            std::snprintf(hex, sizeof hex, "<%02X>", b);
            s += hex;
        } else {
            s += c;
        }
    }
    return s;
}

class Bench {
public:
    explicit Bench(DeviceSetup setup = {}, const NonVolatile& memory = {}) {
        auto m = std::make_unique<PlainMotor>();
        motor = m.get();
        device = std::make_unique<Device>(std::move(setup), std::move(m));
        now = Instant{} + std::chrono::seconds(1);
        device->power_on(memory, now, out_);
        collect();
    }

    /// Bytes as they are; then everything that is due within `wait`. What the drive sent.
    std::string send(std::string_view bytes, Duration wait = milliseconds(5)) {
        sent.clear();
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
        f.at = now;
        device->on_frame(f, now, out_);
        collect();
        pass(wait);
        return sent;
    }
    void pass(Duration d) {
        const Instant end = now + d;
        while (device->deadline() <= end) {
            now = std::max(now, device->deadline());
            device->on_deadline(now, out_);
            collect();
            ++calls;
        }
        now = end;
    }
    /// One line in single mode with EM = 0: its data without echo, line ends and prompt.
    std::string type(const std::string& line, Duration wait = milliseconds(5)) {
        const std::string all = send(line + "\r", wait);
        std::string rest = all.substr(std::min(line.size(), all.size()));
        if (rest.starts_with("\r\n")) rest.erase(0, 2);
        prompt = rest.empty() ? '\0' : rest.back();
        if (prompt == '>' || prompt == '?') rest.pop_back();
        if (rest.ends_with("\r\n")) rest.erase(rest.size() - 2);
        return rest;
    }
    /// Error code after a line that should fail (0: it did not); cleared.
    int error_of(const std::string& line) {
        (void)type(line);
        return std::stoi(type("PR ER"));
    }
    void program(const std::vector<std::string>& lines) {
        (void)type("PG 1");
        for (const auto& l : lines) {
            (void)type(l);
            ASSERT_EQ(prompt, '>') << l;
        }
        (void)type("PG");
    }
    std::string run(const std::vector<std::string>& lines, Duration wait = milliseconds(500)) {
        program(lines);
        (void)type("EX 1", Duration::zero());
        sent.clear();
        pass(wait);
        std::string s = sent;
        if (const auto at = s.find('>'); at != std::string::npos) s = s.substr(at + 1);
        return shown(s);
    }

    Instant now{};
    std::unique_ptr<Device> device;
    PlainMotor* motor = nullptr;
    std::string sent;
    char prompt = '\0';
    long calls = 0;

private:
    void collect() {
        for (const auto& tx : out_.frames)
            sent.append(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size);
        out_.clear();
    }
    Out out_;
};

}  // namespace axisgate::mcode::twin::test
