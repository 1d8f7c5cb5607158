// Bench for freedoms: a drive with some of them, by the names of the page; beside it, where that helps, the drive of the manual.
// In: values by name, bytes, the tester's hand. Out: bytes with their instants.
#pragma once

#include "adapters/mcode/tests/twin_bench.hpp"
#include "adapters/mcode/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::mcode::twin::test {

struct FreeDrive {
    explicit FreeDrive(const FreedomValues& freedoms, char name = '!', std::map<std::string, std::string> options = {}) {
        TwinSetup s;
        s.address = std::string(1, name);
        s.bit_rate = 9600;
        s.options = std::move(options);
        s.freedoms = freedoms;
        s.seed = 1;
        twin = make_twin(Catalogue{}, s);
        twin->power_on({}, now, out_);
        collect();
    }
    /// Bytes, then everything that is due within `wait`; what came.
    std::string bytes(std::string_view b, Duration wait = milliseconds(500)) {
        sent.clear();
        Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(b.data()), b.size()});
        f.at = now;
        twin->on_frame(f, now, out_);
        collect();
        pass(wait);
        return text();
    }
    /// One line with EM = 0 in single mode: its data alone.
    std::string ask(const std::string& line, Duration wait = milliseconds(5)) {
        (void)bytes(line + "\r", wait);
        std::string all = raw();
        const auto echo = all.find(line);
        if (echo != std::string::npos) all.erase(0, echo + line.size());
        while (!all.empty() && (all.back() == '\n' || all.back() == '\r' || all.back() == '>' || all.back() == '?'))
            all.pop_back();
        while (all.starts_with('\r') || all.starts_with('\n'))
            all.erase(0, 1);
        return all;
    }
    double number(const std::string& word) { return std::stod(ask("PR " + word, milliseconds(1))); }
    void lines(const std::vector<std::string>& all) {
        for (const auto& l : all)
            (void)ask(l);
    }
    int error_of(const std::string& line) {
        lines({"ER=0", line});
        return static_cast<int>(number("ER"));
    }
    void hand(const std::string& name, const Value& v) {
        EXPECT_EQ(twin->set_hand(name, v, now, out_), "") << name;
        collect();
    }
    void pass(Duration d) {
        const Instant end = now + d;
        for (int n = 0; twin->deadline() <= end; ++n) {
            ASSERT_LT(n, 1'000'000) << "deadlines do not end";
            now = std::max(now, twin->deadline());
            twin->on_deadline(now, out_);
            collect();
        }
        now = end;
    }
    std::string raw() const {
        std::string all;
        for (const auto& [at, piece] : sent)
            all += piece;
        return all;
    }
    std::string text() const { return shown(raw()); }
    /// ms from `since` to the first piece that begins with a prompt; -1: there is none.
    std::int64_t ms_of_prompt(Instant since) const {
        for (const auto& [at, piece] : sent) {
            if (piece.starts_with('>')) return (at - since) / milliseconds(1);
        }
        return -1;
    }
    /// ms from `since` to the first piece that has this text; -1: there is none.
    std::int64_t ms_of(std::string_view part, Instant since) const {
        for (const auto& [at, piece] : sent) {
            if (shown(piece).find(part) != std::string::npos) return (at - since) / milliseconds(1);
        }
        return -1;
    }
    /// Where the shaft is, in the unit of P.
    double place() const { return twin->mechanics(0, now).position; }

    Instant now = Instant{} + std::chrono::seconds(1);
    std::unique_ptr<Twin> twin;
    std::vector<std::pair<Instant, std::string>> sent;

private:
    void collect() {
        for (const auto& tx : out_.frames)
            sent.emplace_back(tx.frame.at, std::string(reinterpret_cast<const char*>(tx.frame.storage.data()), tx.frame.size));
        out_.clear();
    }
    Out out_;
};

}  // namespace axisgate::mcode::twin::test
