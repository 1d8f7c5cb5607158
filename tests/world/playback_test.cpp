// The state that a recording shows of an instant: axes, registers, frames with their meaning, recent events, curves. It equals the picture
// of that instant; a truncated file shows nothing.
#include <boost/json/serialize.hpp>
#include <map>
#include <set>

#include "gateway/services/recorder/axr.hpp"
#include "gateway/services/recorder/playback.hpp"
#include "tests/world/tape.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
namespace json = boost::json;
constexpr std::int64_t offset_ns = 1'700'000'000'000'000'000;

std::string file_of(const Tape& tape, const SiteState& site) {
    json::object lines{{"0", "line"}}, axes;
    for (std::size_t i = 0; i < site.axis_ids.size(); ++i)
        axes[std::to_string(index_of(site.axis_ids[i]))] = site.site.axes[i].name;
    AxrWriter w;
    w.begin(axr_meta);
    w.add(json::serialize(json::object{{"unix_offset_ns", offset_ns}, {"lines", lines}, {"axes", axes}}));
    w.begin(axr_site);
    w.add(json::serialize(to_json(site.site)));
    w.begin(axr_records);
    w.add(Tape::joined(tape.window));
    return w.finish();
}
Families own() {
    Families f = families();
    f.descriptions = std::make_shared<DescriptionShelf>();
    return f;
}

class PlayedBack : public testing::TestWithParam<Subject> {};
INSTANTIATE_TEST_SUITE_P(Families, PlayedBack, testing::ValuesIn(subjects()), name_of_subject);

TEST_P(PlayedBack, AnInstantIsShownAsItWas) {
    Tape tape;
    World w(7);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(GetParam(), 2));
    const AxisId axis = state->axis_ids[0];
    ASSERT_TRUE(w.run_until_true([&] { return (w.picture(axis).flags & flag_online) != 0; }, 10s));
    w.run_for(1s);
    const Instant early = w.now;
    const std::int64_t then = w.picture(axis).position;
    (void)w.wait(w.command(axis, Enable{}, true), 10s);
    Move m;
    m.target = then + 3000;
    m.velocity = 2000;
    (void)w.wait(w.command(axis, m, true), 20s);
    w.run_for(1s);
    const std::string file = file_of(tape, *state);
    std::string fault;
    const auto end = play_back(file, own(), {std::nullopt, 40, 200}, fault);
    ASSERT_EQ(fault, "");
    const auto position = [&](const json::object& shown) {
        return shown.at("axes").as_array().at(0).as_object().at("position_increments").to_number<std::int64_t>();
    };
    EXPECT_EQ(position(end), w.picture(axis).position);
    const auto& words = end.at("registers").as_array().at(0).as_object().at("words").as_array();
    EXPECT_EQ(words.at(0).to_number<unsigned>(), w.picture(axis).statusword);
    const auto shown = static_cast<std::int32_t>(words.at(2).to_number<std::uint32_t>() << 16 | words.at(3).to_number<std::uint32_t>());
    EXPECT_EQ(shown, static_cast<std::int32_t>(w.picture(axis).position));
    EXPECT_EQ(end.at("frames").as_array().size(), 40u);
    bool read = false, commanded = false;
    for (const auto& f : end.at("frames").as_array())
        read = read || !f.at("decoded").as_array().empty();
    for (const auto& h : end.at("happened").as_array())
        commanded = commanded || h.at("kind").as_string() == "command";
    EXPECT_TRUE(read);
    EXPECT_TRUE(commanded);
    EXPECT_FALSE(end.at("curves").as_array().empty());
    // A command, its result and its frames have one number, however late they were sent.
    const auto whole = play_back(file, own(), {std::nullopt, 20000, 0}, fault);
    std::map<std::int64_t, std::set<std::string>> of_command;
    for (const auto& h : whole.at("happened").as_array())
        if (const auto& n = h.at("command"); !n.is_null())
            of_command[n.to_number<std::int64_t>()].insert(std::string(h.at("kind").as_string()));
    std::set<std::int64_t> sent;
    for (const auto& f : whole.at("frames").as_array()) {
        const auto& n = f.at("command");
        if (n.is_null()) continue;
        sent.insert(n.to_number<std::int64_t>());
        EXPECT_TRUE(f.at("to_drive").as_bool());
        EXPECT_TRUE(of_command.contains(n.to_number<std::int64_t>())) << json::serialize(f);
    }
    ASSERT_GE(of_command.size(), 2u);
    EXPECT_TRUE(sent.contains(of_command.rbegin()->first)) << "the move";
    for (const auto& [n, kinds] : of_command)
        EXPECT_EQ(kinds, (std::set<std::string>{"command", "result"})) << n;
    const auto before = play_back(file, own(), {ns_of(early) + offset_ns, 0, 0}, fault);
    EXPECT_EQ(position(before), then);
    EXPECT_TRUE(before.at("frames").as_array().empty());
    EXPECT_TRUE(before.at("curves").as_array().empty());
}

TEST(Playback, OfAFileThatIsNotToBeTrustedShowsNothing) {
    Tape tape;
    World w(7);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(subjects()[0]));
    w.run_for(500ms);
    const std::string file = file_of(tape, *state);
    std::string fault;
    EXPECT_TRUE(play_back(std::string_view(file).substr(0, file.size() - 9), own(), {}, fault).empty());
    EXPECT_NE(fault.find("cut off"), std::string::npos) << fault;
    std::string altered = file;
    altered[file.size() / 2] ^= 4;
    EXPECT_TRUE(play_back(altered, own(), {}, fault).empty());
    EXPECT_NE(fault.find("altered"), std::string::npos) << fault;
    AxrWriter w2;  // complete, but with wrong content
    for (const auto name : {axr_meta, axr_site, axr_records}) {
        w2.begin(name);
        w2.add(std::string("[\x06\x02"));
    }
    EXPECT_TRUE(play_back(w2.finish(), own(), {}, fault).empty());
    EXPECT_NE(fault, "");
}

}  // namespace
}  // namespace axisgate::test
