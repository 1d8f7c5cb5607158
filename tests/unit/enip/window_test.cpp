// The site's own assemblies on the door: bytes of values in every order, outputs into lanes and writes, the base of a first image, refused
// values beside others, the data sheet.
#include "gateway/doors/enip/window.hpp"

#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "tests/unit/enip/window_bench.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define WINDOW_TEST_COUNTS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WINDOW_TEST_COUNTS 1
#endif
#endif
#ifdef WINDOW_TEST_COUNTS
#include <sanitizer/allocator_interface.h>
#endif

namespace axisgate::enip {
namespace {

#ifdef WINDOW_TEST_COUNTS
std::size_t allocations_of_windows = 0;

TEST(EnipWindow, NothingIsAllocatedForADatagram) {
    WindowBench d;
    for (std::uint16_t i = 0; i < 20; ++i)
        d.add(static_cast<std::uint16_t>(2 * i), i % 2 == 0 ? "feeder" : "slide", "position", MapType::i32);
    d.state.site.assemblies = {d.spec(300, input, 0, 40)};
    d.put_site();
    Bytes data;
    d.values.read(300, d.port.now(), data);  // from the second one on
    static const bool counts = __sanitizer_install_malloc_and_free_hooks(
                                   [](const volatile void*, std::size_t) { ++allocations_of_windows; }, [](const volatile void*) {}) != 0;
    ASSERT_TRUE(counts);
    const std::size_t before = allocations_of_windows;
    for (int i = 0; i < 10; ++i) {
        data.clear();
        d.values.read(300, d.port.now(), data);
        (void)d.values.revision(300);
    }
    EXPECT_EQ(allocations_of_windows, before);
    d.maps.clear();
    d.add(0, "feeder", "statusword", MapType::u16);
    d.put_site();
    d.port.edit(d.one, [](AxisPicture& p) { p.statusword = 0x1637; });
    EXPECT_EQ(d.read(300)[0], 0x37) << "another site, another list";
    EXPECT_EQ(d.read(300)[2], 0);
}
#endif

TEST(EnipWindow, EachValueHasItsLowestByteFirstWhateverItsWordOrder) {
    WindowBench d;
    d.add(0, "feeder", "position", MapType::i32);
    d.add(2, "feeder", "position", MapType::i32, MapAccess::read, MapWordOrder::low_first);
    d.add(5, "slide", "statusword", MapType::u16);
    d.add(6, "feeder", "position", MapType::i64);
    d.add(10, "feeder", "V", MapType::string);
    d.maps.back().length = 2;
    d.state.site.assemblies = {d.spec(300, input, 0, 12), d.spec(301, input, 0, 12)};
    d.state.site.assemblies[1].order = AssemblyOrder::registers;
    d.put_site();
    d.port.edit(d.one, [](AxisPicture& p) { p.position = 0x01020304; });
    d.port.edit(d.two, [](AxisPicture& p) { p.statusword = 0x1637; });
    d.image.on_sample({d.one, Point{1, 0}, Value{std::string("abc")}, Quality::good, d.port.now()});
    EXPECT_EQ(d.read(300), (Bytes{4, 3, 2, 1, 4, 3, 2, 1, 0, 0, 0x37, 0x16, 4, 3, 2, 1, 0, 0, 0, 0, 'a', 'b', 'c', 0}));
    EXPECT_EQ(d.read(301), (Bytes{1, 2, 3, 4, 3, 4, 1, 2, 0, 0, 0x16, 0x37, 0, 0, 0, 0, 1, 2, 3, 4, 'a', 'b', 'c', 0}));
    EXPECT_EQ(d.values.assembly(300)->size, 24);
    EXPECT_EQ(d.values.assemblies().back(), 301u);
}

TEST(EnipWindow, AValueThatNobodyKnowsSpoilsItselfAlone) {
    WindowBench d;
    d.add(0, "feeder", "position", MapType::i32);
    d.add(2, "slide", "AC", MapType::u32);
    d.add(4, "feeder", "statusword", MapType::u16);
    d.state.site.assemblies = {d.spec(300, input, 0, 5)};
    d.put_site();
    d.port.edit(d.one, [](AxisPicture& p) {
        p.position = 7;
        p.statusword = 0x27;
    });
    EXPECT_EQ(d.read(300), (Bytes{7, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0x27, 0})) << "its mark, until the drive has told it";
    const auto before = d.values.revision(300);
    d.image.on_sample({d.two, Point{0, 0}, Value{std::int64_t{300}}, Quality::good, d.port.now()});
    EXPECT_EQ(d.read(300), (Bytes{7, 0, 0, 0, 0x2C, 1, 0, 0, 0x27, 0}));
    EXPECT_NE(d.values.revision(300), before) << "a change of state";
    d.port.edit(d.two, [](AxisPicture& p) { p.flags = 0; });
    EXPECT_EQ(d.read(300)[4], 0xFF) << "of an axis that does not answer";
}

TEST(EnipWindow, AgesAndHeartbeatsAreNoChange) {
    WindowBench d;
    d.add(0, "feeder", "age_ms", MapType::u32);
    d.add(2, "feeder", "heartbeat", MapType::u16);
    d.add(3, "feeder", "position", MapType::i32);
    d.state.site.assemblies = {d.spec(300, input, 0, 5)};
    d.put_site();
    d.port.edit(d.one, [](AxisPicture& p) { p.ever_seen = true; });
    const Bytes was = d.read(300);
    const auto before = d.values.revision(300);
    d.port.time += 5s;
    EXPECT_NE(d.read(300), was);
    EXPECT_EQ(d.values.revision(300), before);
    d.port.edit(d.one, [](AxisPicture& p) { p.position = 1; });
    EXPECT_NE(d.values.revision(300), before);
}

/// feeder's control word, mode and target at 0, 2, 4; slide's AC at 8.
struct WindowOut : WindowBench {
    WindowOut() {
        add(0, "feeder", "controlword", MapType::u16);
        add(1, "feeder", "mode", MapType::i16);
        add(2, "feeder", "target_position", MapType::i32);
        add(4, "slide", "AC", MapType::u32, MapAccess::write);
        state.site.assemblies = {spec(310, output, 0, 6)};
        put_site();
    }
    void send() { values.consumed(310, out, plc, port.now()); }
    Bytes out = Bytes(12);
};

TEST(EnipWindow, OutputsEndInTheLaneAndTheFirstImageIsABase) {
    WindowOut d;
    d.values.opened(310, d.plc, 40ms, d.port.now());
    d.out = {0x1F, 0, 1, 0, 100, 0, 0, 0, 0x2C, 1, 0, 0};
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u) << "its word and mode are handed on, and no parameter";
    const auto first = std::get<ProcessData>(d.port.commands[0].body);
    EXPECT_EQ(first.controlword, 0x0F) << "bit 4 counts as held";
    EXPECT_EQ(first.mode, 1);
    EXPECT_FALSE(first.profile_velocity) << "what it has not is not sent";
    EXPECT_EQ(AuthorityClient::of(d.port.commands[0].origin).text(), "ethernet_ip 192.0.2.7 assembly 310");
    d.port.answer();
    d.send();
    EXPECT_TRUE(d.port.commands.empty());
    d.out[0] = 0x0F;
    d.send();
    d.port.commands.clear();
    d.out[0] = 0x1F;
    d.out[4] = 200;
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands[0].body).target_position, 200);
    EXPECT_EQ(d.port.commands[0].axis, d.one);
    d.values.idle(310, d.plc, d.port.now());
    EXPECT_EQ(d.port.lost.back().second, enip::loss_idle);
    d.port.commands.clear();
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands[0].body).controlword, 0x0F) << "after idle it is a base again";
}

TEST(EnipWindow, AParameterIsWrittenWhenItChangesAndTheNewestWaits) {
    WindowOut d;
    d.values.opened(310, d.plc, 40ms, d.port.now());
    d.out[8] = 50;
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<ProcessData>(d.port.commands[0].body)) << "of the first image the parameter is a base";
    d.port.commands.clear();
    const auto written = [&] { return as_integer(std::get<WriteParameter>(d.port.commands.back().body).value); };
    for (const std::uint8_t v : std::initializer_list<std::uint8_t>{60, 70, 80}) {
        d.out[8] = v;
        d.send();
    }
    ASSERT_EQ(d.port.commands.size(), 1u) << "one on its way";
    EXPECT_EQ(written(), 60);
    EXPECT_EQ(d.port.commands[0].axis, d.two);
    EXPECT_EQ(AuthorityClient::of(d.port.commands[0].origin).text(), "ethernet_ip 192.0.2.7 assembly 310");
    d.port.answer();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(written(), 80);
    d.port.refuse(Reason::drive_refused);
    EXPECT_TRUE(d.port.commands.empty()) << "not again and again";
    EXPECT_NE(d.port.notes.back().first.text.find("unit 40"), std::string::npos) << d.port.notes.back().first.text;
    d.out[8] = 90;
    d.send();
    EXPECT_EQ(written(), 90);
}

TEST(EnipWindow, AValueThatIsRefusedDoesNotHoldUpAStop) {
    WindowOut d;
    d.values.opened(310, d.plc, 40ms, d.port.now());
    d.out[0] = 0x0F;
    d.send();
    d.port.answer();
    d.port.notes.clear();
    d.out = {0x02, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF};
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands[0].body).controlword, 0x02);
    ASSERT_EQ(d.port.notes.size(), 1u) << "AC is beyond its range";
    d.send();
    EXPECT_EQ(d.port.notes.size(), 1u) << "told once";
}

TEST(EnipWindow, ASpeedAloneIsFollowedInTheModeThatTheAxisHas) {
    WindowBench d;
    d.add(0, "feeder", "target_velocity", MapType::i32);
    d.state.site.assemblies = {d.spec(310, output, 0, 2)};
    d.put_site();
    d.port.edit(d.one, [](AxisPicture& p) {
        p.statusword = 0x27;
        p.controlword = 0x0F;
        p.mode = 3;
    });
    d.values.opened(310, d.plc, 40ms, d.port.now());
    Bytes out{100, 0, 0, 0};
    const auto send = [&] { d.values.consumed(310, out, d.plc, d.port.now()); };
    send();
    EXPECT_TRUE(d.port.commands.empty()) << "the base";
    out[0] = 120;
    send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    const auto speed = std::get<ProcessData>(d.port.commands[0].body);
    EXPECT_EQ(speed.target_velocity, 120);
    EXPECT_FALSE(speed.controlword || speed.mode);
    d.port.answer();
    d.port.edit(d.one, [](AxisPicture& p) { p.mode = 9; });
    send();
    ASSERT_EQ(d.port.points.size(), 1u) << "streamed";
    EXPECT_EQ(d.port.points[0].value, 120);
    d.port.edit(d.one, [](AxisPicture& p) { p.controlword = 0x10F; });
    send();
    EXPECT_EQ(d.port.points.size(), 1u) << "not while it is halted by another";
}

TEST(EnipWindow, OneOwnerOfAnAxisHoweverItIsMapped) {
    WindowOut d;
    EXPECT_TRUE(d.values.overlap(310, 151));
    EXPECT_TRUE(d.values.overlap(152, 310));
    EXPECT_TRUE(d.values.overlap(310, 150));
    d.add(20, "slide", "controlword", MapType::u16);
    d.state.site.assemblies = {d.spec(310, output, 0, 4), d.spec(311, output, 20, 1)};
    d.put_site();
    EXPECT_FALSE(d.values.overlap(310, 311));
    EXPECT_FALSE(d.values.overlap(310, 152));
    d.port.time += 1s;
    d.port.edit(d.two, [&](AxisPicture& p) {
        p.authority = http::clients;
        p.authority_until = d.port.now() + 10s;
        std::snprintf(p.authority_holder.data(), p.authority_holder.size(), "anne");
    });
    EXPECT_TRUE(d.values.held_by_another(311, d.plc, d.port.now()));
    EXPECT_FALSE(d.values.held_by_another(310, d.plc, d.port.now()));
}

TEST(EnipWindow, AMessageWritesAllOfItOrNothing) {
    WindowOut d;
    const Bytes good{0x06, 0, 1, 0, 0, 0, 0, 0, 50, 0, 0, 0}, bad{0x06, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    bool later = false;
    EXPECT_EQ(d.values.write(310, bad, 1, d.plc, d.port.now(), later), General::invalid_attribute_value) << "AC is 0";
    EXPECT_TRUE(d.port.commands.empty());
    EXPECT_FALSE(later);
    EXPECT_EQ(d.values.write(310, good, 2, d.plc, d.port.now(), later), General::success);
    EXPECT_EQ(d.port.commands.size(), 2u);
    EXPECT_TRUE(later && d.published.empty());
    d.port.answer();
    d.port.refuse(Reason::wrong_state);
    ASSERT_EQ(d.published.size(), 1u);
    EXPECT_EQ(d.published[0].general, General::device_state_conflict);
}

TEST(EnipWindow, TheSheetListsThemWithAConnectionOfTheirOwn) {
    WindowOut d;
    d.add(30, "feeder", "position", MapType::i32, MapAccess::read);
    d.state.site.assemblies.push_back(d.spec(311, input, 30, 2));
    d.state.site.assemblies.back().comment = "where it is";
    d.put_site();
    const std::string sheet = eds_of(d.values.layout());
    EXPECT_NE(sheet.find("Assem311 = \"where it is to the originator\", \"20 04 25 00 37 01 30 03\", 4"), std::string::npos) << sheet;
    EXPECT_NE(sheet.find("Assem310 = "), std::string::npos);
    EXPECT_NE(sheet.find("\"Owner: unit 40 0..5 from the originator\", \"\", \"20 04 24 C7 2D 00 36 01 2D 00 37 01\""), std::string::npos)
        << sheet;
}

}  // namespace
}  // namespace axisgate::enip
