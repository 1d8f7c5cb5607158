// Profiles on EtherNet/IP: the image of a language in cycles, whose first one starts nothing, and the classes of a maker's manual.
#include <set>

#include "gateway/doors/enip/window.hpp"
#include "gateway/protocols/cip/adapter.hpp"
#include "tests/unit/enip/window_bench.hpp"

namespace axisgate::enip {
namespace {

struct WindowProfile : WindowBench {
    void speak(ProfileLanguage language, std::uint16_t object = 0) {
        ProfileSpec p;
        p.unit = 50;
        p.language = language;
        p.axes = {{"feeder", {}, 100.0, 1000.0}};
        p.input_assembly = 400;
        p.output_assembly = 401;
        if (object != 0) p.object_instance = object;
        state.site.profiles = {p};
        put_site();
        for (const AxisId id : {one, two})
            port.edit(id, [](AxisPicture& x) { x.statusword = 0x0627; });
        out.resize(values.assembly(401)->size);
        values.opened(401, plc, 40ms, port.now());
    }
    void put16(std::size_t at, std::uint16_t v) {
        out[at] = static_cast<std::uint8_t>(v);
        out[at + 1] = static_cast<std::uint8_t>(v >> 8);
    }
    void put32(std::size_t at, std::uint32_t v) {
        put16(at, static_cast<std::uint16_t>(v));
        put16(at + 2, static_cast<std::uint16_t>(v >> 16));
    }
    void send() { values.consumed(401, out, plc, port.now()); }
    Bytes out;
};

TEST(EnipWindow, ALexiumImageOrdersWhatChangesAndKeepsItsSettings) {
    WindowProfile d;
    d.speak(ProfileLanguage::lexium);
    d.put32(0, 5000);        // A
    d.put32(2 * 67, 777);    // MA
    d.put16(2 * 28, 1);      // DE
    d.put32(2 * 87, 12345);  // P
    d.send();
    EXPECT_TRUE(d.port.commands.empty()) << "the first image starts nothing, and zeros beyond their ranges are no fault";
    EXPECT_TRUE(d.port.notes.empty() || d.port.notes.back().first.text.find("opened") != std::string::npos);
    d.put32(2 * 67, 800);
    d.put32(2 * 139, 4000);  // VM, behind MA
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    const auto m = std::get<Move>(d.port.commands[0].body);
    EXPECT_EQ(m.target, 800);
    EXPECT_EQ(m.velocity, 4000) << "settings of the same image first";
    EXPECT_EQ(m.acceleration, 5000) << "that of the first image counts";
    d.port.answer();
    d.send();
    EXPECT_TRUE(d.port.commands.empty());
    d.put16(2 * 75, 1);   // O1, which nobody has
    d.put32(2 * 120, 1);  // SL
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u) << "beside what is refused";
    EXPECT_EQ(std::get<Move>(d.port.commands[0].body).kind, Move::Kind::velocity);
    const Bytes in = d.read(400);
    EXPECT_EQ(in[2 * 31], 1) << "EF";
    EXPECT_EQ(in[2 * 33], 37) << "ER: not in this product";
}

TEST(EnipWindow, APaControlTakesItsToggleFromTheFirstImage) {
    WindowProfile d;
    d.speak(ProfileLanguage::pacontrol);
    const auto word = [&](std::size_t reg, std::uint16_t v) {  // the image begins with the highest byte
        d.out[2 * reg] = static_cast<std::uint8_t>(v >> 8);
        d.out[2 * reg + 1] = static_cast<std::uint8_t>(v);
    };
    word(3, 0x8603);  // ONLINE, with SF set: it was executed before
    word(4, 0x0017);  // CTRL with its ONLINE bit
    word(9, 0x0045);  // axis 1: on, start, absolute
    d.send();
    EXPECT_TRUE(d.port.commands.empty());
    EXPECT_EQ(d.read(400)[2 * 2 + 1], 1) << "home position";
    EXPECT_EQ(d.read(400)[2 * 3], 0xA0) << "RF answers SF";
    word(4, 0x0007);
    d.send();
    word(4, 0x0017);
    d.send();
    EXPECT_EQ(d.read(400)[2 * 2 + 1], 31) << "ONLINE by an edge";
    const auto starts = [&] {
        return std::ranges::count_if(d.port.commands, [](const Command& c) { return std::holds_alternative<Move>(c.body); });
    };
    EXPECT_EQ(starts(), 0);
    word(9, 0x0041);
    d.send();
    word(12, 0x4120);  // 10.0
    word(9, 0x0045);
    d.send();
    EXPECT_EQ(starts(), 0) << "a speed of 0 is refused with 29h, and so is an acceleration of 0";
    word(9, 0x0041);
    d.send();
    word(10, 1000);
    word(11, 1001);
    word(9, 0x0045);
    d.send();
    EXPECT_EQ(starts(), 0) << "above 1000 per mill as well";
    word(9, 0x0041);
    d.send();
    word(11, 1000);
    word(9, 0x0045);
    d.send();
    EXPECT_EQ(starts(), 1);
}

TEST(EnipWindow, ALinMotTakesItsCountFromTheFirstImageAndStopsByALevel) {
    WindowProfile d;
    d.speak(ProfileLanguage::linmot);
    d.put16(0, 0x003E);
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Disable>(d.port.commands[0].body)) << "whoever has switched it on: the first word has bit 0 clear";
    d.port.commands.clear();
    d.put16(0, 0x003F);
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u) << "power";
    d.port.answer(Outcome::done);
    EXPECT_EQ(d.read(400)[1], 8) << "operation enabled";
    d.values.idle(401, d.plc, d.port.now());
    d.put16(0, 0x0A3F);  // home and a jog bit, from before
    d.put16(2, 0x0102);  // a command with another count
    d.put32(4, 5000);
    d.put32(8, 1000);
    d.put32(12, 1000);
    d.put32(16, 1000);
    d.port.commands.clear();
    d.send();
    EXPECT_TRUE(d.port.commands.empty()) << "after idle nothing of the image starts anything";
    EXPECT_EQ(d.read(400)[1], 8);
    d.put16(0, 0x003F);
    d.put16(2, 0x0103);
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Move>(d.port.commands[0].body));
    d.values.idle(401, d.plc, d.port.now());
    d.port.commands.clear();
    d.put16(0, 0x002F);  // abort, by its level
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Halt>(d.port.commands[0].body));
}

TEST(EnipWindow, TheBlockOfCia402IsAnImageLikeThoseOfTheAxes) {
    WindowProfile d;
    d.speak(ProfileLanguage::cia402);
    ASSERT_EQ(d.out.size(), 32u);
    d.port.edit(d.one, [](AxisPicture& p) { p.position = -2; });
    const Bytes mine = d.read(400), axis = d.read(101);
    EXPECT_EQ(Bytes(mine.begin(), mine.begin() + 32), axis);
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands[0].body).controlword, 0) << "the first image is handed on whole";
    d.port.answer();
    d.put16(0, 0x0F);
    d.put16(2, 1);
    d.put32(4, 500);
    d.send();
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands[0].body).target_position, 500);
}

TEST(EnipWindow, TheImageOfALanguageIsWhatItsPageHas) {
    const auto pages = WindowBench::languages();
    for (std::size_t l = 0; l < pages.size(); ++l) {
        WindowBench d;
        ProfileSpec p;
        p.unit = 50;
        p.language = static_cast<ProfileLanguage>(l);
        p.axes = {{"feeder", {}, {}, {}}};
        if (p.language == ProfileLanguage::pacontrol) p.axes.push_back({"slide", {}, {}, {}});
        p.input_assembly = 400;
        p.output_assembly = 401;
        d.state.site.profiles = {p};
        d.put_site();
        const auto windows = windows_of(d.state);
        ASSERT_GE(windows.size(), 2u) << name_of(p.language);
        for (const auto& w : windows) {
            const bool out = w.spec.direction == output;
            const auto in_image = d.image.unit(50)->values(w.spec.table, w.spec.address, w.spec.registers, out);
            ASSERT_FALSE(in_image.empty());
            const auto all = d.image.unit(50)->values(w.spec.table, out ? 0 : w.spec.address, 255, out);
            if (p.language == ProfileLanguage::cia402) continue;  // its image is that of an axis, the block has more
            EXPECT_EQ(in_image.size(), all.size()) << name_of(p.language) << " has more than its image";
            EXPECT_EQ(in_image.back().address + in_image.back().registers, w.spec.address + w.spec.registers) << name_of(p.language);
        }
    }
}

struct WindowNowhere final : cip::Output {
    void implicit(cip::Endpoint, cip::View, std::uint8_t) override {}
    void stream(cip::SessionKey, cip::View b) override { last.assign(b.begin(), b.end()); }
    void datagram(cip::Endpoint, cip::View) override {}
    void hang_up(cip::SessionKey) override {}
    Bytes last;
};

/// The classes that the manual prints, asked through the whole adapter.
struct WindowObjects : WindowProfile {
    WindowObjects() {
        speak(ProfileLanguage::lexium, 3);
        values.ended(401, plc, cip::End::closed, port.now());
        values.use([this](cip::Token t, General g, cip::View v, std::uint16_t x) { adapter.answered(t, g, v, x); });
        EXPECT_TRUE(adapter.on_connected(1, plc.from, port.now()));
        cip::Header h;
        h.command = 0x65;
        adapter.on_stream(1, cip::packet(h, Bytes{1, 0, 0, 0}), port.now());
        session = cip::read_header(nowhere.last).session;
    }
    /// Nothing: no answer yet.
    std::optional<cip::Answer> ask(std::uint8_t service, std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute,
                                   const Bytes& data = {}) {
        Bytes path, body(6);
        cip::put_class(path, class_id);
        cip::put_instance(path, instance);
        if (attribute != 0) cip::put_attribute(path, attribute);
        cip::put16(body, 2);
        cip::put_item(body, cip::item::null_address, {});
        cip::put_item(body, cip::item::unconnected_data, cip::request(service, path, data));
        cip::Header h;
        h.command = 0x6F;
        h.session = session;
        nowhere.last.clear();
        adapter.on_stream(1, cip::packet(h, body), port.now());
        return answer();
    }
    std::optional<cip::Answer> answer() {
        if (nowhere.last.empty()) return std::nullopt;
        const auto items = cip::read_items(cip::View(nowhere.last).subspan(cip::header_size + 6));
        return cip::read_answer(items->list[1].data);
    }
    WindowNowhere nowhere;
    cip::Adapter adapter{values, nowhere, 1};
    std::uint32_t session = 0;
};

TEST(EnipOwnClasses, ALexiumsAttributesAreItsRegisters) {
    WindowObjects d;
    d.port.edit(d.one, [](AxisPicture& p) { p.position = 0x01020304; });
    using namespace cip::service;
    EXPECT_EQ(d.ask(get_single, 0x68, 3, 3)->data, (Bytes{4, 3, 2, 1})) << "P";
    EXPECT_EQ(d.ask(get_single, 0x64, 3, 3)->data, (Bytes{1, 0})) << "DE";
    EXPECT_EQ(d.ask(set_single, 0x66, 3, 1, {0x10, 0x27, 0, 0})->general, General::success) << "A is kept, at once";
    EXPECT_EQ(d.ask(get_single, 0x66, 3, 1)->data, (Bytes{0x10, 0x27, 0, 0}));
    EXPECT_FALSE(d.ask(set_single, 0x66, 3, 7, {0xE8, 3, 0, 0})) << "MA is answered when its drive has answered";
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<Move>(d.port.commands[0].body).target, 1000);
    EXPECT_EQ(std::get<Move>(d.port.commands[0].body).acceleration, 10'000);
    d.port.answer();
    ASSERT_TRUE(d.answer());
    EXPECT_EQ(d.answer()->general, General::success);
    EXPECT_FALSE(d.ask(set_single, 0x66, 3, 7, {0, 0, 0, 0}));
    d.port.refuse(Reason::wrong_state);
    ASSERT_TRUE(d.answer());
    EXPECT_EQ(d.answer()->general, General::device_state_conflict);
    EXPECT_EQ(d.ask(get_single, 0x65, 3, 3)->data, (Bytes{94, 0})) << "ER: drive is disabled";
}

TEST(EnipOwnClasses, WhatIsNotThereHasItsStatus) {
    WindowObjects d;
    using namespace cip::service;
    EXPECT_EQ(d.ask(get_single, 0x66, 1, 1)->general, General::object_does_not_exist) << "another instance";
    EXPECT_EQ(d.ask(get_single, 0x66, 3, 99)->general, General::attribute_not_supported);
    EXPECT_EQ(d.ask(get_single, 0x6B, 3, 1)->general, General::path_destination_unknown) << "another class";
    EXPECT_EQ(d.ask(get_single, 0x66, 3, 7)->general, General::attribute_not_gettable) << "MA is written alone";
    EXPECT_EQ(d.ask(set_single, 0x66, 3, 12, {1, 0})->general, General::attribute_not_settable) << "MV";
    EXPECT_EQ(d.ask(set_single, 0x66, 3, 7, {1, 0})->general, General::not_enough_data);
    EXPECT_EQ(d.ask(set_single, 0x66, 3, 7, {1, 0, 0, 0, 0})->general, General::too_much_data);
    EXPECT_EQ(d.ask(set_single, 0x66, 3, 1, {0, 0, 0, 0})->general, General::invalid_attribute_value) << "A is beyond its range";
    EXPECT_EQ(d.ask(get_single, 0x67, 3, 9)->general, General::attribute_not_supported) << "an input that nobody knows is no 0";
    EXPECT_EQ(d.ask(get_all, 0x66, 3, 0)->general, General::service_not_supported);
    EXPECT_EQ(d.ask(set_list, 0x66, 3, 0, {1, 0, 7, 0, 1, 0, 0, 0})->general, General::attribute_list_error);
    EXPECT_EQ(d.ask(get_single, 0x66, 0, 2)->data, (Bytes{3, 0})) << "the highest instance";
    EXPECT_TRUE(d.port.commands.empty());
    d.state.site.profiles.clear();
    d.put_site();
    EXPECT_EQ(d.ask(get_single, 0x66, 3, 1)->general, General::path_destination_unknown) << "it went with the profile";
}

TEST(EnipOwnClasses, NoTwoRegistersHaveOneAttribute) {
    std::set<std::pair<int, int>> seen;
    const auto page = WindowBench::languages()[static_cast<std::size_t>(ProfileLanguage::lexium)];
    for (const auto& r : page->rows) {
        if (r.object) EXPECT_TRUE(seen.emplace(r.object->class_id, r.object->attribute).second) << r.name;
    }
    EXPECT_GT(seen.size(), 60u);
}

}  // namespace
}  // namespace axisgate::enip
