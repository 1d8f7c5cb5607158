// The real catalogue against the adapter: every point is bound to commands that exist, every action and command of it is known.
#include <fstream>
#include <sstream>

#include "adapters/pacontrol/tests/fake_bench.hpp"
#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

const Catalogue& real_catalogue() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/pacontrol.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

TEST(PacontrolCatalogue, EveryPointIsBound) {
    const Catalogue& c = real_catalogue();
    const Elements e(c);
    for (std::uint16_t i = 0; i < c.parameters().size(); ++i) {
        const Parameter& p = c.parameters()[i];
        const Binding* b = e.binding({i, p.first});
        ASSERT_TRUE(b);
        if (p.readable()) {
            EXPECT_TRUE(b->read) << p.id;
        }
        if (p.writable()) {
            EXPECT_TRUE(b->write) << p.id;
        }
        if (!b->read) continue;
        EXPECT_EQ(p.wire.at("scope").as_string() == "drive", b->drive) << p.id;
        const Request r = Elements::read(*b, {i, p.first}, 3);
        EXPECT_EQ(command_info(r.code), b->read) << p.id;
        const bool of_axis = b->read->parameter == Takes::axis || b->read->parameter == Takes::axis_parameter;
        EXPECT_TRUE(!of_axis || !b->drive) << p.id << ": a value of one axis is not the drive's";
        if (b->read->parameter == Takes::axis) {
            EXPECT_EQ(r.parameter, 3u) << p.id;
        }
        if (b->read->parameter == Takes::axis_parameter) {
            EXPECT_EQ(r.parameter >> 8, 3u) << p.id;
        }
        if (b->read->parameter != Takes::nothing) {
            EXPECT_GT(r.parameter, 0u) << p.id;
        }
    }
}

struct Golden {
    const char* id;
    int channel;
    const char* read;
    const char* write;  ///< of 1
};

TEST(PacontrolCatalogue, PointsCrossTheWireAsTheManualSays) {
    const Catalogue& c = real_catalogue();
    const Elements e(c);
    for (const Golden& g : {Golden{"I[5]", 1, "1900;5;0;0", nullptr}, Golden{"IW[2]", 1, "1901;17;0;0", nullptr},
                            Golden{"O[1024]", 4, "1902;1024;0;0", "0902;1024;0;1"}, Golden{"OW[1]", 1, "1903;1;0;0", "0903;1;0;1"},
                            Golden{"M[17]", 1, "1904;17;0;0", "0904;17;0;1"}, Golden{"MW[64]", 1, "1905;1009;0;0", "0905;1009;0;1"},
                            Golden{"N[17]", 2, "1906;17;0;0", "0906;17;0;1"}, Golden{"R[1]", 1, "1907;1;1;0", "0907;1;1;1.0"},
                            Golden{"SP[2]", 3, "1700;2;0;0", "0700;2;0;1"}, Golden{"AP[6]", 3, "1800;774;1;0", "0800;774;1;1.0"},
                            Golden{"AP[50]", 16, "1800;4146;1;0", "0800;4146;1;1.0"}, Golden{"POS", 2, "190C;2;1;0", nullptr},
                            Golden{"STATE", 2, "190B;0;0;0", nullptr}, Golden{"RUNNING", 2, "1911;0;0;0", nullptr},
                            Golden{"SM.REFERENCED", 2, "1934;52;0;0", nullptr}, Golden{"SR.TARGET", 16, "1937;86;1;0", nullptr},
                            Golden{"SN10", 5, "1935;10;0;0", nullptr}, Golden{"SP_MAX[2]", 1, "1701;2;0;0", nullptr},
                            Golden{"AP_MIN[50]", 1, "1802;306;1;0", nullptr}}) {
        const auto p = c.find(g.id);
        ASSERT_TRUE(p) << g.id;
        const Binding* b = e.binding(*p);
        EXPECT_EQ(text_of(Elements::read(*b, *p, g.channel)), g.read) << g.id;
        ASSERT_EQ(b->write != nullptr, g.write != nullptr) << g.id;
        if (g.write) {
            EXPECT_EQ(text_of(Elements::write(*b, *p, g.channel, Value{std::int64_t{1}})), g.write) << g.id;
        }
    }
}

TEST(PacontrolCatalogue, PartsOfTheExtendedStatusCountFromTheHighestByte) {
    const Catalogue& c = real_catalogue();
    const Elements e(c);
    Reply r;
    r.data = "16777476";  // 0100 0104h [L3186]
    const auto value = [&](const char* id) { return as_integer(Elements::value(*e.binding(*c.find(id)), r)); };
    EXPECT_EQ(value("EXT.READY"), 1);
    EXPECT_EQ(value("EXT.LIMIT_POS"), 0);
    EXPECT_EQ(value("EXT.LIMIT_NEG"), 1);
    EXPECT_EQ(value("EXT.STATUS"), 4);
    EXPECT_EQ(value("EXT"), 16777476);
}

TEST(PacontrolCatalogue, EveryCommandAndActionIsKnownToTheAdapter) {
    std::size_t codes = 0;
    for (const auto& c : real_catalogue().commands()) {
        if (const CommandInfo* info = command_named(c.name); info && c.name.starts_with("cmd_")) {
            ++codes;
            EXPECT_EQ(c.name, info->name);
            EXPECT_EQ(command_named(c.id), info) << c.id;
            continue;
        }
        Enabled b;
        const Result r = b.action(c.name, "?");
        EXPECT_NE(r.reason, Reason::unknown_point) << c.name;
        EXPECT_FALSE(r.text.empty()) << c.name;
    }
    EXPECT_EQ(codes, all_commands().size());
}

TEST(PacontrolCatalogue, EveryNumberOfAFaultIsASystemErrorWithAText) {
    for (int code = 1; code <= 999; ++code) {
        const ErrorCode* e = real_catalogue().error(code);
        ASSERT_TRUE(e) << code;
        EXPECT_EQ(e->kind, "system") << code << ": a command error of the same number is another thing";
        EXPECT_FALSE(e->text.empty()) << code;
    }
    EXPECT_EQ(real_catalogue().error(64, "command")->text, "Limit switch actuated");
    for (const int own : {530, 531, 532, 533})  // negative switch, following error, power pack, a program's move
        EXPECT_NE(real_catalogue().error(own)->text.find("simulated control"), std::string::npos) << own << ": no number of the manual's";
}

TEST(PacontrolCatalogue, CommandErrorsHaveTheSameWordsInBothPlaces) {
    std::size_t seen = 0;
    for (const auto& e : real_catalogue().errors()) {
        if (e.kind != "command") continue;
        ++seen;
        EXPECT_EQ(quit_text(static_cast<std::uint16_t>(e.code)).find("does not name"), std::string::npos) << e.code << " " << e.text;
    }
    EXPECT_GT(seen, 20u);
}

/// What a snapshot of an axis reads: all but what the catalogue leaves out of it.
std::vector<Point> snapshot_points() {
    std::vector<Point> points;
    const Catalogue& c = real_catalogue();
    const auto& listed = c.document().at("parameters").as_array();
    for (std::uint16_t i = 0; i < c.parameters().size(); ++i) {
        const Parameter& p = c.parameters()[i];
        const auto* wanted = listed[i].as_object().if_contains("snapshot");
        if (p.readable() && p.count <= 256 && !(wanted && !wanted->as_bool())) points.push_back({i, p.first});
    }
    return points;
}

TEST(PacontrolCatalogue, ASnapshotOfAnAxisIsReadInLessThanFiveSeconds) {
    Rig r(3, {}, real_catalogue());
    const Instant begun = r.now;
    const auto points = snapshot_points();
    for (const Point p : points) {
        const Result x = r.answer(r.command(ReadParameter{p}, 0));
        EXPECT_EQ(x.outcome, Outcome::done) << real_catalogue().id_of(p) << ": " << x.text;
    }
    EXPECT_EQ(points.size(), 59u) << "the 13 system and 40 axis parameters that are used; area, position, statuses, error";
    std::printf("a snapshot of an axis at 9600 baud takes %.2f s\n", seconds(r.now - begun));
    EXPECT_LT(r.now - begun, 5s);
}

TEST(PacontrolCatalogue, SnapshotsOfSeveralAxesAtOnceAskOnceForWhatTheyShare) {
    Rig r(3, {}, real_catalogue());
    const std::size_t before = r.handed.size();
    for (const Point p : snapshot_points()) {
        std::vector<Ticket> tickets;
        for (int axis = 0; axis < 3; ++axis)
            tickets.push_back(r.command(ReadParameter{p}, axis));
        std::vector<Result> results;
        for (const Ticket t : tickets)
            results.push_back(r.answer(t));
        for (const Result& x : results) {
            EXPECT_EQ(x.outcome, Outcome::done) << x.text;
            if (real_catalogue().id_of(p).starts_with("SP")) EXPECT_EQ(x.value, results.front().value);
        }
    }
    const auto asked = [&](const char* code) {
        return std::count_if(r.handed.begin() + static_cast<std::ptrdiff_t>(before), r.handed.end(),
                             [&](const auto& h) { return h.text.starts_with(code); });
    };
    EXPECT_EQ(asked("1700"), 13);
    EXPECT_GE(asked("1800"), 120);
}

TEST(PacontrolCatalogue, TheManualsWordsAreFound) {
    const auto found = [](std::string_view id, std::string_view words) {
        const Parameter* p = real_catalogue().parameter(*real_catalogue().find(id));
        return p->description.find(words) != std::string::npos;
    };
    EXPECT_TRUE(found("AP[17]", "Maximum towfault"));
    EXPECT_TRUE(found("AP[8]", "Minimum traverse area"));
    EXPECT_TRUE(found("FE", "towfault"));
    EXPECT_NE(real_catalogue().error(16, "command")->cause.find("Sum of digits"), std::string::npos);
    EXPECT_EQ(real_catalogue().document().at("telegram_fields").as_array().size(), 34u);
    for (const auto& e : real_catalogue().document().at("errors").as_array()) {
        if (e.at("kind").as_string() == "command")
            EXPECT_EQ(e.at("source").as_string().find('-'), std::string::npos) << e.at("code") << ": its own line";
    }
}

}  // namespace
}  // namespace axisgate::pacontrol::test
