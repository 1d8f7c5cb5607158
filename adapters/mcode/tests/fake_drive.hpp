// Fake drive for the adapter's tests: answers lines of MCode in the shape of EM, PY and CK, with what a test puts into it.
// In: the adapter's bytes. Out: scripted bytes; every line that it heard. Time is the test's.
// Never runs the language: values are a table, PR prints from it, NAME=VALUE writes to it, MA and SL set P or V.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "adapters/mcode/tests/bench_commands.hpp"

namespace axisgate::mcode::test {
using namespace std::chrono_literals;

struct FakeDrive {
    char name = 'a';
    int em = 0, ck = 0;
    bool awake = false, silent = false, in_program = false;
    bool stuck = false;  ///< PG does not lead it out
    int er = 0, resets = 0;
    std::map<std::string, std::string> values{
        {"P", "0"},  {"V", "0"},  {"MV", "0"},        {"MP", "0"},     {"VC", "0"},      {"DE", "1"},      {"BY", "0"},
        {"ST", "0"}, {"LR", "0"}, {"AS", "0"},        {"VI", "1000"},  {"VM", "768000"}, {"A", "1000000"}, {"D", "1000000"},
        {"EE", "0"}, {"IF", "0"}, {"PN", "LMDCM571"}, {"VR", "6.011"}, {"ES", "1"},      {"BD", "96"},     {"CE", "1"}};
    std::map<std::string, int> refuse;  ///< line -> error code
    std::set<std::string> lose;         ///< lines that are executed once and not answered
    std::string er_text;                ///< what ER prints instead of its code, and stays
    std::string deaf_after;             ///< says nothing any more after this line
    std::vector<std::string> received_lines, program;
    std::string buffer;

    static char sum(std::string_view s) {
        unsigned n = 0;
        for (const char c : s)
            n += static_cast<std::uint8_t>(c);
        return static_cast<char>(((0U - n) & 0x7F) | 0x80);
    }
    std::string take(std::string_view bytes) {
        std::string out;
        for (const char c : bytes) {
            if (c == '\x03' && (values["CE"] == "1" || (values["CE"] == "2" && (name == '!' || buffer == std::string(1, name))))) {
                ++resets;
                buffer.clear();
                awake = in_program = false;
                em = ck = 0;
                values["ES"] = values["CE"] = "1";
            } else if (c == (name == '!' ? '\r' : '\n')) {
                out += line(std::move(buffer));
                buffer.clear();
            } else {
                buffer += c;
            }
        }
        return silent ? std::string() : out;
    }
    std::string line(std::string s) {
        if (name != '!') {
            if (!awake) {
                awake = true;
                return {};
            }
            if (s.empty() || s[0] != name) return {};
        }
        const std::string received = s;
        const int was_em = em, was_ck = ck;
        bool good = true;
        if (ck > 0) {
            unsigned n = 0;
            for (const char c : s)
                n += static_cast<std::uint8_t>(c);
            if ((n & 0x7F) != 0) return em == 2 ? "" : "\x15";
            s.pop_back();
        }
        if (name != '!') s.erase(0, 1);
        received_lines.push_back(s);
        const bool lost = lose.erase(s) > 0;
        if (!deaf_after.empty() && s == deaf_after) silent = true;
        std::string data;
        bool printed = false;
        if (in_program && word_of(s) != "PG") {
            program.push_back(s);
        } else if (const auto it = refuse.find(s); it != refuse.end()) {
            er = it->second;
            good = false;
        } else if (s.starts_with("PR ")) {
            good = print(s.substr(3), data);
            printed = good;
        } else if (s == "L") {
            data = "1 PG 1\r\n";
            int n = 2;
            for (const auto& p : program)
                data += std::to_string(n++) + " " + p + "\r\n";
            data += "99 PG";
            printed = true;
        } else if (word_of(s) == "PG") {
            in_program = !in_program || stuck;  // PG toggles, whatever was meant
        } else if (s == "CP" || s == "CP 1") {
            program.clear();
        } else if (s.starts_with("MA ")) {
            values["P"] = s.substr(3);
        } else if (s.starts_with("SL ")) {
            values["V"] = s.substr(3);
            values["MV"] = values["V"] == "0" ? "0" : "1";
        } else if (s.starts_with("HM ")) {
            values["MV"] = "0";
        } else if (const auto eq = s.find('='); eq != std::string::npos) {
            const std::string w = s.substr(0, eq), v = s.substr(eq + 1);
            if (w == "EM")
                em = std::stoi(v);
            else if (w == "CK")
                ck = std::stoi(v);
            else if (w == "ER")
                er = 0;
            else
                values[w] = v;
        }
        if (lost) return {};
        std::string out;
        if (was_em == 0 || was_em == 3) out += name == '!' ? received : received.substr(1);  // without the name [L6840-6860]
        if (was_em != 2) out += was_ck > 0 ? std::string(1, good ? '\x06' : '\x15') : "\r\n";
        if (printed) out += data + (was_ck > 0 ? std::string(1, sum(data)) : std::string()) + "\r\n";
        if (was_em == 0) out += er ? '?' : '>';
        return out;
    }
    bool print(const std::string& items, std::string& data) {
        std::string item;
        bool quoted = false;
        std::vector<std::string> list;
        for (const char c : items) {
            if (c == '"') quoted = !quoted;
            if (c == ',' && !quoted) {
                list.push_back(item);
                item.clear();
            } else {
                item += c;
            }
        }
        list.push_back(item);
        for (const auto& i : list) {
            if (i[0] == '"')
                data += i.substr(1, i.size() - 2);
            else if (i == "EM")
                data += std::to_string(em);
            else if (i == "CK")
                data += std::to_string(ck);
            else if (i == "EF")
                data += er ? "1" : "0";
            else if (i == "ER") {
                data += er_text.empty() ? std::to_string(er) : er_text;
                if (er_text.empty()) er = 0;
            } else if (values.contains(i)) {
                data += values[i];
            } else {
                er = 35;
                return false;
            }
        }
        return true;
    }
};

inline const Catalogue& catalogue() {
    static const auto c = [] {
        std::ifstream in(std::string(AXISGATE_SOURCE_DIR) + "/schema/families/mcode.json");
        std::stringstream s;
        s << in.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f;
        return std::make_unique<Catalogue>(std::move(*parsed));
    }();
    return *c;
}

/// One adapter with fake drives behind a wire that takes `delay`.
struct Bench : BenchCommands<Bench> {
    LineAdapter adapter{catalogue()};
    std::vector<FakeDrive> drives;
    Instant now = at_ns(1'000'000'000);
    Duration delay = 2ms;
    Out out;
    std::vector<Notice> notices;
    std::vector<std::string> sent;
    std::vector<std::pair<Instant, std::string>> coming;
    std::map<AxisId, AxisFeedback> feedback;
    std::vector<std::pair<Ticket, bool>> reached_at_result;
    LineSetup setup;

    explicit Bench(std::vector<char> names = {'a'}) {
        setup.id = LineId{0};
        setup.bit_rate = 9600;
        for (std::size_t i = 0; i < names.size(); ++i) {
            FakeDrive f;
            f.name = names[i];
            drives.push_back(f);
            DriveSetup d;
            d.id = DriveId{static_cast<std::uint16_t>(i)};
            d.name = "d" + std::to_string(i);
            d.address = std::string(1, names[i]);
            d.axes.push_back({AxisId{static_cast<std::uint16_t>(i)}, 1});
            setup.drives.push_back(d);
        }
    }
    void up() {
        adapter.configure(setup, now, out);
        drain();
        adapter.on_line(true, now, out);
        drain();
    }
    void drain() {
        for (const auto& f : out.feedback)
            feedback[f.axis] = f.value;
        for (const auto& r : out.results) {
            results.push_back(r);
            reached_at_result.emplace_back(r.ticket, feedback[r.axis].target_reached);
        }
        links.insert(links.end(), out.links.begin(), out.links.end());
        notices.insert(notices.end(), out.notices.begin(), out.notices.end());
        for (const auto& tx : out.frames) {
            const std::string bytes(reinterpret_cast<const char*>(tx.frame.data().data()), tx.frame.size);
            sent.push_back(bytes);
            std::string all;
            for (auto& d : drives)
                all += d.take(bytes);
            if (!all.empty()) coming.emplace_back(now + delay, all);
        }
        out.clear();
    }
    void receive(std::string_view bytes) {
        adapter.on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}), now, out);
        drain();
    }
    void run(Duration d) {
        const Instant end = now + d;
        for (int guard = 0; guard < 100000; ++guard) {
            Instant due = adapter.deadline();
            for (const auto& c : coming)
                due = std::min(due, c.first);
            if (due > end) break;
            now = std::max(now, due);
            if (!coming.empty() && coming.front().first <= now) {
                const std::string bytes = coming.front().second;
                coming.erase(coming.begin());
                receive(bytes);
            } else {
                adapter.on_deadline(now, out);
                drain();
            }
        }
        now = end;
    }
};

}  // namespace axisgate::mcode::test
