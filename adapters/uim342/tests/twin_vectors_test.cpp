// Plays every exchange of vectors.txt against the twin: on CAN, and as UIMessages with both CRC ranges and without CRC.
// In: adapters/uim342/vectors.txt (its head explains the format). Out: one failure per line that does not come as written.
// Never shares a parser or a packer with the adapter's tests.
#include <deque>
#include <fstream>
#include <optional>

#include "adapters/uim342/tests/twin_bench.hpp"
#include "adapters/uim342/twin/wire.hpp"

namespace axisgate::uim342::test {
namespace {

using twin::Form;
using twin::Telegram;

struct Step {
    int line = 0;
    std::string keyword;
    std::vector<std::string> words;
};
struct Case {
    int line = 0;
    std::string name;
    bool wire = false;
    bool stream = false;
    std::string node = "5";
    std::vector<Step> steps;
};

std::vector<Case> read_cases(const std::string& path) {
    std::ifstream in(path);
    std::vector<Case> cases;
    std::string text_line;
    for (int n = 1; std::getline(in, text_line); ++n) {
        text_line = text_line.substr(0, text_line.find('#'));
        std::istringstream words(text_line);
        Step s;
        s.line = n;
        if (!(words >> s.keyword)) continue;
        for (std::string w; words >> w;)
            s.words.push_back(w);
        if (s.keyword == "case") {
            cases.push_back({n, s.words.at(0), false, false, "5", {}});
        } else if (s.keyword == "wire") {
            cases.back().wire = true;
        } else if (s.keyword == "node") {
            cases.back().node = s.words.at(0);
        } else {
            cases.back().stream = cases.back().stream || s.keyword == "stream>";
            cases.back().steps.push_back(s);
        }
    }
    return cases;
}

std::vector<std::uint8_t> bytes_of(const std::vector<std::string>& words, std::size_t from = 0) {
    std::vector<std::uint8_t> b;
    b.reserve(16);  // an address even without data: Frame copies from it
    for (std::size_t i = from; i < words.size(); ++i)
        b.push_back(static_cast<std::uint8_t>(std::stoul(words[i], nullptr, 16)));
    return b;
}

/// The same words, xx being anything.
bool matches(const std::vector<std::string>& pattern, std::size_t from, std::span<const std::uint8_t> got) {
    if (pattern.size() - from != got.size()) return false;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const std::string& w = pattern[from + i];
        if (w != "xx" && std::stoul(w, nullptr, 16) != got[i]) return false;
    }
    return true;
}

bool has_wildcard(const std::vector<std::string>& words) { return std::ranges::find(words, "xx") != words.end(); }

/// How a case is spoken.
enum class Tongue { can, crc12, crc13, plain };
const char* name_of(Tongue t) { return t == Tongue::can ? "can" : t == Tongue::crc12 ? "uim" : t == Tongue::crc13 ? "uim13" : "plain"; }

class Player {
public:
    Player(const Case& c, Tongue tongue) : case_(c), tongue_(tongue) {
        TwinSetup s;
        s.address = c.node;
        s.kind = tongue == Tongue::can ? LineKind::can : LineKind::bytes;
        if (tongue == Tongue::crc13) s.options["crc"] = "13";
        twin_ = make(s);
        Out out;
        twin_->power_on({}, now_, out);
        take(out);
        EXPECT_TRUE(come_.empty());
    }

    void play() {
        for (const Step& s : case_.steps) {
            SCOPED_TRACE(case_.name + " (" + name_of(tongue_) + "), line " + std::to_string(s.line));
            step(s);
        }
        SCOPED_TRACE(case_.name + " (" + name_of(tongue_) + "), end");
        for (const Frame& f : come_)
            ADD_FAILURE() << "also came: " << to_text(f);
    }

private:
    /// Between the last `<` and the next action; what comes before any `<` is still to be asked for.
    void next_action() {
        if (answered_) nothing_left();
        answered_ = false;
    }
    void nothing_left() {
        for (const Frame& f : come_)
            ADD_FAILURE() << "also came: " << to_text(f);
        come_.clear();
    }
    void take(const Out& out) {
        for (const auto& tx : out.frames)
            come_.push_back(tx.frame);
    }
    void wait(Duration d) {
        const Instant end = now_ + d;
        while (twin_->deadline() <= end) {
            now_ = std::max(now_, twin_->deadline());
            Out out;
            twin_->on_deadline(now_, out);
            take(out);
        }
        now_ = end;
    }
    void hand(const std::string& name, const std::string& value) {
        Out out;
        EXPECT_EQ(twin_->set_hand(name, Value{std::int64_t{std::stoll(value)}}, now_, out), "");
        take(out);
    }
    void frame(const Frame& f) {
        Out out;
        twin_->on_frame(f, now_, out);
        take(out);
    }
    /// ID CW DL DATA.
    void send(const std::vector<std::uint8_t>& m) {
        ASSERT_EQ(m.size(), 3u + m[2]);
        if (tongue_ == Tongue::can) {
            frame(Frame::can_extended(host_id(m[0], m[1]), std::span(m).subspan(3)));
            return;
        }
        std::array<std::uint8_t, 16> u{};
        u[0] = tongue_ == Tongue::plain ? 0xAD : 0xAA;
        std::ranges::copy(m, u.begin() + 1);
        std::uint16_t crc = 0;
        if (tongue_ == Tongue::crc12) crc = twin::crc16(std::span(u).subspan(1, 12));
        if (tongue_ == Tongue::crc13) crc = twin::crc16(std::span(u).first(13));
        u[13] = static_cast<std::uint8_t>(crc);
        u[14] = static_cast<std::uint8_t>(crc >> 8);
        u[15] = 0xCC;
        sent_.assign(u.begin(), u.end());
        frame(Frame::run(u));
    }

    void step(const Step& s) {
        const std::string& k = s.keyword;
        if (k == "state") {
            const std::string& what = s.words.at(0);
            if (what == "hand") {
                hand(s.words.at(1), s.words.at(2));
            } else if (what == "wait") {
                wait(std::chrono::milliseconds(std::stoll(s.words.at(1))));
            } else {
                send(bytes_of(s.words));
                for (const Frame& f : come_) {
                    const auto t = telegram(f);
                    EXPECT_NE(t.size() > 1 ? t[1] : 0, 0x0F) << "the state is refused: " << to_text(f);
                }
            }
            come_.clear();
        } else if (k == ">") {
            next_action();
            send(bytes_of(s.words));
        } else if (k == "stream>") {
            next_action();
            for_each_run(bytes_of(s.words), [this](const Frame& f) { frame(f); });
        } else if (k == "hand") {
            next_action();
            hand(s.words.at(0), s.words.at(1));
        } else if (k == "wait") {
            next_action();
            wait(std::chrono::milliseconds(std::stoll(s.words.at(0))));
        } else if (k == "<" && s.words.at(0) == "none") {
            answered_ = true;
            last_.reset();
            nothing_left();
        } else if (k == "<" || k == "<~") {
            answered_ = true;
            last_.reset();
            if (come_.empty()) {
                ADD_FAILURE() << "nothing came";
                return;
            }
            last_ = come_.front();
            come_.pop_front();
            EXPECT_TRUE(matches(s.words, 0, telegram(*last_))) << "came: " << text(telegram(*last_));
        } else if (k == "can>" && tongue_ == Tongue::can) {
            const auto id = std::stoul(s.words.at(0), nullptr, 16);
            EXPECT_EQ(twin::consumer_of(static_cast<std::uint32_t>(id)),
                      twin::read_can(Frame::can_extended(static_cast<std::uint32_t>(id), no_data))->consumer);
        } else if (k == "can<" && tongue_ == Tongue::can && last_) {
            EXPECT_EQ(last_->id, std::stoul(s.words.at(0), nullptr, 16));
            EXPECT_TRUE(matches(s.words, 1, last_->data())) << to_text(*last_);
        } else if (k == std::string(name_of(tongue_)) + ">" && tongue_ != Tongue::can) {
            EXPECT_TRUE(matches(s.words, 0, sent_)) << "this test would have said " << text(sent_);
        } else if (k == std::string(name_of(tongue_)) + "<" && tongue_ != Tongue::can && last_) {
            EXPECT_TRUE(matches(s.words, 0, last_->data())) << to_text(*last_);
        }
    }

    /// ID CW DL DATA of a frame of the drive.
    std::vector<std::uint8_t> telegram(const Frame& f) const {
        std::vector<std::uint8_t> t;
        if (f.kind == Frame::Kind::can) {
            t = {static_cast<std::uint8_t>(((f.id >> 24) & 0x1Fu) | ((f.id >> 11) & 0x60u)), static_cast<std::uint8_t>(f.id & 0xFFu),
                 static_cast<std::uint8_t>(f.size)};
            t.insert(t.end(), f.data().begin(), f.data().end());
            return t;
        }
        EXPECT_EQ(f.size, 16u);
        const auto b = f.data();
        t.assign(b.begin() + 1, b.begin() + 4 + b[3]);
        for (std::size_t i = 4u + b[3]; i < 13; ++i)
            EXPECT_EQ(b[i], 0) << "unused bytes";
        return t;
    }

    const Case& case_;
    Tongue tongue_;
    std::unique_ptr<Twin> twin_;
    Instant now_ = time_zero;
    std::deque<Frame> come_;
    std::optional<Frame> last_;
    bool answered_ = false;
    std::vector<std::uint8_t> sent_;
};

const std::vector<Case>& cases() {
    static const std::vector<Case> all = read_cases(std::string(AXISGATE_SOURCE_DIR) + "/adapters/uim342/vectors.txt");
    return all;
}

TEST(TwinVectors, EveryExchangeInEveryTongue) {
    std::size_t played = 0;
    for (const Case& c : cases()) {
        if (c.wire) continue;
        for (const Tongue t : {Tongue::can, Tongue::crc12, Tongue::crc13, Tongue::plain}) {
            if (c.stream && t != Tongue::crc12) continue;
            Player(c, t).play();
            ++played;
        }
    }
    EXPECT_GT(played, 400u);
}

/// Packing and unpacking alone, for all lines that give bytes; and the CRC figures.
TEST(TwinVectors, EveryLineOfBytes) {
    std::size_t checked = 0;
    for (const Case& c : cases()) {
        Telegram t;
        for (const Step& s : c.steps) {
            SCOPED_TRACE(c.name + ", line " + std::to_string(s.line));
            if (s.keyword == ">" || s.keyword == "<" || s.keyword == "<~") {
                t = {};
                if (s.words[0] == "none" || has_wildcard(s.words)) {
                    t.dl = 0xFF;  // not to be used
                    continue;
                }
                const auto m = bytes_of(s.words);
                (s.keyword == ">" ? t.consumer : t.producer) = m[0];
                (s.keyword == ">" ? t.producer : t.consumer) = twin::host_id;
                t.cw = m[1];
                t.dl = m[2];
                std::copy(m.begin() + 3, m.end(), t.d.begin());
                continue;
            }
            if (s.keyword == "crc") {
                const auto equals = std::ranges::find(s.words, "=");
                const std::vector<std::string> data(s.words.begin(), equals);
                EXPECT_EQ(twin::crc16(bytes_of(data)), std::stoul(*(equals + 1), nullptr, 16));
                ++checked;
                continue;
            }
            if (s.keyword == "crclow") {
                const auto row = bytes_of(s.words);
                for (std::size_t i = 0; i < 16; ++i) {
                    // The table's entry i is the CRC of the byte FF^i without the start value's own part.
                    const std::array<std::uint8_t, 1> b{static_cast<std::uint8_t>(0xFFu ^ (row[0] + i))};
                    EXPECT_EQ(twin::crc16(b) >> 8, row.at(1 + i)) << i;
                }
                ++checked;
                continue;
            }
            if (t.dl == 0xFF || has_wildcard(s.words)) continue;
            const bool down = s.keyword.back() == '>';
            if (s.keyword == "can>" || s.keyword == "can<") {
                const auto f = Frame::can_extended(static_cast<std::uint32_t>(std::stoul(s.words[0], nullptr, 16)), bytes_of(s.words, 1));
                const auto got = twin::read_can(f);
                ASSERT_TRUE(got);
                EXPECT_EQ(got->producer, t.producer);
                EXPECT_EQ(got->consumer, t.consumer);
                EXPECT_EQ(got->cw, t.cw);
                EXPECT_EQ(got->dl, t.dl);
                EXPECT_EQ(got->d, t.d);
                EXPECT_TRUE(twin::write_can(t).same(f)) << to_text(twin::write_can(t));
                ++checked;
                continue;
            }
            const std::string tongue = s.keyword.substr(0, s.keyword.size() - 1);
            if (tongue != "uim" && tongue != "uim13" && tongue != "plain") continue;
            const Form form = tongue == "uim" ? Form::crc12 : tongue == "uim13" ? Form::crc13 : Form::plain;
            const auto bytes = bytes_of(s.words);
            if (down) {
                std::size_t count = 0;
                twin::MessageReader(twin::CrcRange::automatic).feed(bytes, [&](const Telegram& got, Form got_form) {
                    ++count;
                    EXPECT_EQ(got_form, form);
                    EXPECT_EQ(got.consumer, t.consumer);
                    EXPECT_EQ(got.cw, t.cw);
                    EXPECT_EQ(got.dl, t.dl);
                    EXPECT_EQ(got.d, t.d);
                });
                EXPECT_EQ(count, 1u);
            } else {
                EXPECT_EQ(text(twin::write_message(t, form)), text(bytes));
            }
            ++checked;
        }
    }
    EXPECT_GT(checked, 500u);
}

}  // namespace
}  // namespace axisgate::uim342::test
