// The languages of register profiles, each by one script in front of every family and wire: the reads and writes of a machine's old program
// move the axis behind it, and impossible requests are answered in the language's own way. The same scripts are used over each way of the
// language: Modbus, its image on EtherNet/IP, its classes and attributes there.
#include <gtest/gtest.h>

#include <bit>

#include "gateway/axis/cia402.hpp"
#include "gateway/registers/words.hpp"
#include "tests/conformance/doors.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
using namespace registers;

class ProfileLaws : public Laws, public WriteOwner {
protected:
    enum class Way { modbus, image, attributes };
    static constexpr std::uint8_t unit = 10;
    static constexpr std::uint16_t in_instance = 400, out_instance = 401;
    World& w = *world;
    WorldDoors port{*world};
    std::unique_ptr<RegisterImage> image;
    std::unique_ptr<WriterDoor> door;
    std::unique_ptr<EnipDoor> scanner;  ///< unless the way is Modbus
    Way way = Way::modbus;
    std::vector<std::uint8_t> renewed;  ///< the registers of the image
    bool begun = false;
    WordOrder words = WordOrder::high_first;
    std::optional<Verdict> answered;

    void on_written(std::uint8_t, AxisId, Verdict verdict) override { answered = verdict; }

    /// One axis behind a unit with this language; 100 increments are one unit, 40 u/s and 200 u/s^2 its full speed and ramp.
    void speak(ProfileLanguage language, Way by, std::optional<double> counts_per_unit = {}) {
        way = by;
        start();
        RegisterImage::Settings settings;
        settings.languages = languages();
        image = std::make_unique<RegisterImage>(port, settings);
        door = std::make_unique<WriterDoor>(port, *image);
        Site profiled = site->site;
        ProfileSpec spec;
        spec.unit = unit;
        spec.language = language;
        spec.axes = {{"a1", counts_per_unit, 40.0, 200.0}};
        if (way != Way::modbus) {
            spec.input_assembly = in_instance;
            spec.output_assembly = out_instance;
        }
        if (way == Way::attributes) spec.object_instance = 1;
        profiled.profiles = {spec};
        site = w.change(std::move(profiled));
        a1 = site->axis_ids.at(0);
        image->on_site(*site);
        ASSERT_TRUE(image->unit(unit));
        if (const auto& page = settings.languages[static_cast<std::size_t>(language)]) words = page->word_order;
        if (way == Way::modbus) return;
        scanner = std::make_unique<EnipDoor>(port, *image);
        scanner->values.use(
            enip::Layout({{1, a1, "a1", nullptr}}, 1, {}, enip::windows_of(*site), enip::objects_of(*site, settings.languages)));
        renewed.resize(spec_of(out_instance).bytes());
        if (way == Way::image) scanner->values.opened(out_instance, plc, 100ms, w.now);
    }
    const AssemblySpec& spec_of(std::uint16_t instance) const { return scanner->values.layout().window(instance)->spec; }
    std::vector<MapValue> values_of(const AssemblySpec& a, bool written) const {
        return image->unit(unit)->values(a.table, a.address, a.registers, written);
    }
    /// The cycle of a scanner that renews its image; only the language reports refusals.
    void renew() {
        const auto& a = spec_of(out_instance);
        std::vector<std::uint8_t> bytes(a.bytes());
        enip::to_assembly(a, values_of(a, true), renewed.data(), bytes.data());
        scanner->values.consumed(out_instance, bytes, plc, w.now);
    }
    Verdict write_image(std::uint16_t address, const std::vector<std::uint8_t>& data) {
        const auto& a = spec_of(out_instance);
        if (address < a.address || address + data.size() / 2 > a.address + std::size_t{a.registers}) return Verdict::no_address;
        // A scanner begins with zeros; one of a LinMot writes its word at once, so that it is seen not to start.
        const bool linmot = site->site.profiles[0].language == ProfileLanguage::linmot;
        if (!std::exchange(begun, true) && !linmot) renew();
        std::ranges::copy(data, renewed.begin() + 2 * (address - a.address));
        const bool lexium = site->site.profiles[0].language == ProfileLanguage::lexium;
        const auto before = lexium ? holding(lex_error) : 0;
        renew();
        w.run_for(20ms);
        port.deliver();
        return lexium && holding(lex_error) != before ? Verdict::failed : Verdict::good;
    }
    /// Empty: the register has no attribute.
    std::optional<Verdict> write_attribute(std::uint16_t address, const std::vector<std::uint8_t>& data) {
        const auto& rows = scanner->values.languages()[static_cast<std::size_t>(ProfileLanguage::lexium)]->rows;
        const auto row = std::ranges::find(rows, address, &LanguageRow::address);
        if (row == rows.end() || !row->object || data.size() != 2u * row->width()) return std::nullopt;
        cip::Bytes value;
        if (row->width() == 1) {
            cip::put16(value, get16(data.data()));
        } else {
            cip::put32(value, get32(data.data(), words));
        }
        bool later = false;
        scanner->published.reset();
        auto general = scanner->values.set_own({row->object->class_id, 1, row->object->attribute}, value, ++tokens, plc, w.now, later);
        if (later) {
            EXPECT_TRUE(until([&] { return scanner->published.has_value(); })) << "a write has an answer";
            general = scanner->published.value_or(cip::General::connection_lost);
        }
        return general == cip::General::success ? Verdict::good : Verdict::failed;
    }
    static constexpr std::uint16_t lex_error = 33;
    cip::Peer plc{{0xC0000207, 50'000}, 1};
    cip::Token tokens = 0;
    bool until(const std::function<bool()>& condition, Duration limit = 60s) {
        return w.run_until_true(
            [&] {
                port.deliver();
                return condition();
            },
            limit);
    }
    /// Of registers from `address`; waits for the answer.
    Verdict write(std::uint16_t address, const std::vector<std::uint16_t>& values) {
        std::vector<std::uint8_t> data(2 * values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            put16(data.data() + 2 * i, values[i]);
        if (way == Way::attributes) {
            const auto verdict = write_attribute(address, data);
            EXPECT_TRUE(verdict) << "register " << address << " has no attribute";
            return verdict.value_or(Verdict::no_address);
        }
        if (way == Way::image) return write_image(address, data);
        answered.reset();
        const auto count = static_cast<std::uint16_t>(values.size());
        const auto begun = door->writer.write({this, std::make_shared<const std::string>("192.0.2.7:5")}, 0, *image->unit(unit),
                                              Table::holding_registers, address, count, data.data(), {}, w.now);
        if (begun.verdict != Verdict::good || begun.outstanding == 0) return begun.verdict;
        EXPECT_TRUE(until([&] { return answered.has_value(); })) << "a write has an answer";
        return answered.value_or(Verdict::no_answer);
    }
    Verdict write32(std::uint16_t address, std::uint32_t value) {
        const auto high = static_cast<std::uint16_t>(value >> 16), low = static_cast<std::uint16_t>(value);
        return words == WordOrder::high_first ? write(address, {high, low}) : write(address, {low, high});
    }
    std::uint32_t read(Table table, std::uint16_t address, std::uint16_t count) {
        port.deliver();
        if (const auto shown = read_enip(table, address, count)) return *shown;
        const auto r = image->read(unit, table, address, count);
        EXPECT_EQ(r.verdict, Verdict::good) << "register " << address;
        if (r.verdict != Verdict::good) return 0;
        return count == 1 ? get16(r.bytes.data()) : get32(r.bytes.data(), words);
    }
    /// Empty: this way has no such register.
    std::optional<std::uint32_t> read_enip(Table table, std::uint16_t address, std::uint16_t count) {
        if (way == Way::modbus) return std::nullopt;
        if (way == Way::attributes) {
            const auto& rows = scanner->values.languages()[static_cast<std::size_t>(ProfileLanguage::lexium)]->rows;
            const auto row = std::ranges::find(rows, address, &LanguageRow::address);
            if (row == rows.end() || !row->object || !row->readable) return std::nullopt;
            cip::Bytes b;
            EXPECT_EQ(scanner->values.get_own({row->object->class_id, 1, row->object->attribute}, w.now, b), cip::General::success)
                << address;
            EXPECT_EQ(b.size(), 2u * count);
            b.resize(4);
            return cip::Reader(b).u32();
        }
        const auto& a = spec_of(in_instance);
        if (table != a.table || address < a.address || address + count > a.address + a.registers) return std::nullopt;
        cip::Bytes b;
        scanner->values.read(in_instance, w.now, b);
        std::vector<std::uint8_t> registers(b.size());
        enip::from_assembly(a, values_of(a, false), b.data(), registers.data());
        const std::uint8_t* const at = registers.data() + 2 * (address - a.address);
        return count == 1 ? get16(at) : get32(at, words);
    }
    std::uint32_t holding(std::uint16_t address, std::uint16_t count = 1) { return read(Table::holding_registers, address, count); }
    std::uint32_t input(std::uint16_t address, std::uint16_t count = 1) { return read(Table::input_registers, address, count); }
    std::int64_t increments() { return now().position; }
    void play_block(Way by);
    void play_linmot(Way by);
};

/// The registers of a Lexium drive, by the names of its manual.
constexpr std::uint16_t lex_a = 0, lex_d = 24, lex_de = 28, lex_ef = 31, lex_er = 33, lex_i1 = 45, lex_ma = 67, lex_mr = 70, lex_mv = 74,
                        lex_p = 87, lex_sl = 120, lex_vm = 139;

class LexiumScript : public ProfileLaws {
protected:
    void play(Way by);
};

void LexiumScript::play(Way by) {
    speak(ProfileLanguage::lexium, by);
    ASSERT_EQ(write(lex_de, {1}), Verdict::good);
    ASSERT_TRUE(until([&] { return holding(lex_de) == 1; }, 10s)) << "it does not come under power";
    ASSERT_EQ(write32(lex_vm, 4000), Verdict::good);
    ASSERT_EQ(write32(lex_a, 20000), Verdict::good);
    ASSERT_EQ(write32(lex_d, 20000), Verdict::good);
    EXPECT_EQ(holding(lex_vm, 2), 4000u);
    const auto from = increments();
    ASSERT_EQ(write32(lex_ma, static_cast<std::uint32_t>(from + 8000)), Verdict::good);
    ASSERT_TRUE(until([&] { return holding(lex_mv) == 1; }, 5s));
    ASSERT_TRUE(until([&] { return holding(lex_mv) == 0; }));
    w.run_for(500ms);
    EXPECT_EQ(increments(), from + 8000);
    EXPECT_EQ(static_cast<std::int32_t>(holding(lex_p, 2)), from + 8000);
    ASSERT_EQ(write32(lex_mr, static_cast<std::uint32_t>(-2000)), Verdict::good);
    ASSERT_TRUE(until([&] { return increments() == from + 6000; })) << increments();
    w.run_for(500ms);
    if (write32(lex_sl, 3000) == Verdict::good) {
        EXPECT_TRUE(until([&] { return speed(a1) > 2500; }, 10s));
        ASSERT_EQ(write32(lex_sl, 0), Verdict::good);
        EXPECT_TRUE(until([&] { return holding(lex_mv) == 0 && speed(a1) == 0; }, 10s));
    } else {
        EXPECT_EQ(holding(lex_er), 37u) << "not in this product, as the drive would say";
        EXPECT_EQ(holding(lex_ef), 1u);
        // An image that is 0 all the time acknowledges nothing: the error stays until the next instruction.
        if (way != Way::image) ASSERT_EQ(write(lex_er, {0}), Verdict::good);
    }
    if (way != Way::image) EXPECT_EQ(holding(lex_ef), 0u);
    EXPECT_EQ(image->read(unit, Table::holding_registers, lex_i1, 1).verdict, Verdict::failed) << "an input that nobody knows is no 0";
    ASSERT_EQ(write(lex_de, {0}), Verdict::good);
    ASSERT_TRUE(until([&] { return holding(lex_de) == 0; }, 10s));
    EXPECT_NE(write32(lex_ma, 0), Verdict::good) << "without power";
    EXPECT_EQ(holding(lex_er), 94u) << "drive is disabled";
}

TEST_P(LexiumScript, MovesTheAxisByRegisters) { play(Way::modbus); }
TEST_P(LexiumScript, MovesTheAxisByItsImage) { play(Way::image); }
TEST_P(LexiumScript, MovesTheAxisByAttributes) { play(Way::attributes); }

class PaControlScript : public ProfileLaws {
protected:
    void play_interface(Way by);
    void play_commands(Way by);
    bool sf = false;
    struct Reply {
        std::uint32_t data = 0;
        std::uint16_t code = 0, status = 0;
        [[nodiscard]] bool failed() const { return (code & 0x4000) != 0; }
        [[nodiscard]] bool done() const { return (code & 0x2000) != 0; }
        [[nodiscard]] unsigned error() const { return code & 0x1FFF; }
        [[nodiscard]] float real() const { return std::bit_cast<float>(data); }
    };
    Reply reply() { return {input(0, 2), static_cast<std::uint16_t>(input(3)), static_cast<std::uint16_t>(input(2))}; }
    /// One command, until its end.
    Reply ask_pa(std::uint16_t code, std::uint16_t parameter = 0, std::uint32_t data = 0) {
        begin(code, parameter, data);
        EXPECT_TRUE(until([&] { return reply().done() || reply().failed(); })) << std::hex << code;
        return reply();
    }
    void begin(std::uint16_t code, std::uint16_t parameter = 0, std::uint32_t data = 0) {
        sf = !sf;
        EXPECT_EQ(write(0, {static_cast<std::uint16_t>(data >> 16), static_cast<std::uint16_t>(data), parameter,
                            static_cast<std::uint16_t>(code | (sf ? 0x8000 : 0))}),
                  Verdict::good);
        EXPECT_EQ((reply().code & 0x8000) != 0, sf) << "recognised";
    }
    static std::uint32_t real(float f) { return std::bit_cast<std::uint32_t>(f); }
};

void PaControlScript::play_commands(Way by) {
    speak(ProfileLanguage::pacontrol, by);
    EXPECT_EQ(input(2), 0u) << "no communication yet";
    EXPECT_EQ(ask_pa(0x0A87, 1, real(1)).error(), 0x14u) << "only in ONLINE";
    ASSERT_FALSE(ask_pa(0x0603).failed());
    EXPECT_EQ(reply().status & 0xFF, 31);
    ASSERT_TRUE(until([&] { return power_state_of(now().statusword) == PowerState::operation_enabled; }, 10s));
    if ((now().flags & flag_referenced) == 0) EXPECT_EQ(ask_pa(0x0A87, 1, real(1)).error(), 0x2Bu) << "no reference point";
    float base = 5;
    if (const Reply r = ask_pa(0x0A96, 1, real(base)); r.failed()) {  // a drive that can only set the present position to 0
        EXPECT_EQ(r.error(), 0x15u);
        base = 0;
        ASSERT_FALSE(ask_pa(0x0A83, 1).failed());
        ASSERT_FALSE(ask_pa(0x0A85, 1).failed());
    }
    const auto at = [&](float units) { return static_cast<std::int64_t>((base + units) * 100); };
    ASSERT_TRUE(until([&] { return increments() == at(0); }, 5s)) << increments();
    EXPECT_EQ(ask_pa(0x190C, 1).real(), base);
    begin(0x0A87, 1, real(base + 40));
    EXPECT_FALSE(reply().done()) << "not before it is there";
    ASSERT_TRUE(until([&] { return reply().done(); }));
    EXPECT_FALSE(reply().failed()) << reply().error();
    EXPECT_EQ(increments(), at(40));
    EXPECT_EQ(reply().real(), base + 40);
    ASSERT_FALSE(ask_pa(0x0A95, 1, real(-10)).failed());
    EXPECT_EQ(ask_pa(0x1910, 1).data, 1u) << "moving";
    EXPECT_EQ(ask_pa(0x0A94, 1, real(0)).error(), 0x2Au) << "axis still moves";
    ASSERT_TRUE(until([&] { return increments() == at(30); }));
    w.run_for(500ms);
    EXPECT_EQ(ask_pa(0x1910, 1).data, 0u) << "in position";
    ASSERT_FALSE(ask_pa(0x0A94, 1, real(1000)).failed());
    ASSERT_TRUE(until([&] { return speed(a1) > 1000; }, 5s));
    const Reply stopped = ask_pa(0x0A93, 1);
    EXPECT_FALSE(stopped.failed()) << stopped.error();
    EXPECT_EQ(speed(a1), 0) << "done at standstill";
    ASSERT_FALSE(ask_pa(0x0A81).failed());
    EXPECT_EQ(reply().status & 0xFF, 1);
    EXPECT_EQ(ask_pa(0x0A87, 2, real(1)).error(), 0x14u);
}
TEST_P(PaControlScript, ACommandSequenceMovesTheAxis) { play_commands(Way::modbus); }
TEST_P(PaControlScript, ACommandSequenceMovesTheAxisByItsImage) { play_commands(Way::image); }

void PaControlScript::play_interface(Way by) {
    speak(ProfileLanguage::pacontrol, by);
    constexpr std::uint16_t axis = 8;
    const auto control = [&](std::uint32_t bits, float target, std::uint16_t speed_permille = 500) {
        const auto t = real(target);
        return write(axis, {static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint16_t>(bits), 1000, speed_permille,
                            static_cast<std::uint16_t>(t >> 16), static_cast<std::uint16_t>(t)});
    };
    ASSERT_EQ(write(4, {0x0007}), Verdict::good);
    ASSERT_EQ(control(0, 0), Verdict::good);
    ASSERT_EQ(write(4, {0x0017}), Verdict::good);
    EXPECT_EQ(input(2) & 0xFF, 31u) << "ONLINE";
    w.run_for(1s);
    EXPECT_NE(power_state_of(now().statusword), PowerState::operation_enabled) << "its own bit switches the axis on";
    ASSERT_EQ(control(1, 0), Verdict::good);
    ASSERT_TRUE(until([&] { return (input(axis, 2) & 1) != 0; }, 10s));
    ASSERT_EQ(control(1 | 1u << 4 | 1u << 2, 0), Verdict::good) << "set position and reference";
    ASSERT_TRUE(until([&] { return increments() == 0 && (input(axis, 2) & 1u << 8) != 0; }, 5s));
    ASSERT_EQ(control(1, 0), Verdict::good);
    ASSERT_EQ(control(1 | 1u << 6 | 1u << 2, 20), Verdict::good);
    EXPECT_NE(input(axis, 2) & 1u << 7, 0u) << "active";
    ASSERT_TRUE(until([&] { return increments() == 2000; })) << increments() << " status " << std::hex << input(axis, 2);
    w.run_for(500ms);
    EXPECT_NE(input(axis, 2) & 1u << 7, 0u) << "until start is taken back";
    ASSERT_EQ(control(1 | 1u << 6 | 1u << 2, 30), Verdict::good) << "no edge";
    w.run_for(1s);
    EXPECT_EQ(increments(), 2000) << "once per start";
    ASSERT_EQ(control(1, 30), Verdict::good);
    EXPECT_EQ(input(axis, 2) & 1u << 7, 0u);
    EXPECT_EQ(std::bit_cast<float>(input(axis + 4, 2)), 20.0F);
    ASSERT_EQ(control(1 | 1u << 6 | 1u << 7 | 1u << 2, 30), Verdict::good) << "two at once";
    EXPECT_EQ(input(axis + 2), 0x14u);
    EXPECT_NE(input(axis, 2) & 1u << 14, 0u);
    ASSERT_EQ(control(1, 30), Verdict::good);
    ASSERT_EQ(control(1 | 1u << 7 | 1u << 2, 1000), Verdict::good);
    ASSERT_TRUE(until([&] { return speed(a1) > 500; }, 5s));
    ASSERT_EQ(write(4, {0x0005}), Verdict::good) << "stop is low-active";
    ASSERT_TRUE(until([&] { return speed(a1) == 0; }, 10s));
    EXPECT_TRUE(until([&] { return (input(2) & 0xFF) == 35; }, 5s));
    ASSERT_EQ(control(0, 0), Verdict::good);
    EXPECT_TRUE(until([&] { return (input(axis, 2) & 1) == 0; }, 10s)) << "switched off";
}
TEST_P(PaControlScript, AnAxisInterfaceMovesTheAxisOncePerStart) { play_interface(Way::modbus); }
TEST_P(PaControlScript, AnAxisInterfaceMovesTheAxisOncePerStartByItsImage) { play_interface(Way::image); }

void ProfileLaws::play_linmot(Way by) {
    speak(ProfileLanguage::linmot, by, 10'000);  // 100 counts of 0.1 um are one increment
    const auto command = [&](std::uint16_t header, std::int32_t position) {
        const auto p = static_cast<std::uint32_t>(position);
        constexpr std::uint32_t v = 40'000, a = 20'000;  // 1e-6 m/s, 1e-5 m/s^2: 40 and 200 units
        const auto low = [](std::uint32_t x) { return static_cast<std::uint16_t>(x); };
        const auto high = [](std::uint32_t x) { return static_cast<std::uint16_t>(x >> 16); };
        return write(1, {header, low(p), high(p), low(v), high(v), low(a), high(a), low(a), high(a)});
    };
    EXPECT_EQ(input(0) >> 8, 0u) << "locked";
    ASSERT_EQ(write(0, {0x003F}), Verdict::good);
    w.run_for(1s);
    EXPECT_EQ(input(0) >> 8, 0u) << "a complete word does not start it";
    ASSERT_EQ(write(0, {0x003E}), Verdict::good);
    ASSERT_EQ(write(0, {0x003F}), Verdict::good);
    ASSERT_TRUE(until([&] { return input(0) >> 8 == 8; }, 10s)) << std::hex << input(0);
    ASSERT_EQ(command(0x0091, 0), Verdict::good) << "here is 0";
    ASSERT_TRUE(until([&] { return increments() == 0; }, 5s));
    ASSERT_EQ(command(0x0102, 300'000), Verdict::good);
    ASSERT_TRUE(until([&] { return (input(0) & 0x20) != 0; }, 5s)) << "motion active";
    ASSERT_TRUE(until([&] { return increments() == 3000; })) << increments() << " " << std::hex << input(0);
    w.run_for(500ms);
    EXPECT_EQ(input(0) & 0x6Fu, 0x42u) << "in target, count 2";
    EXPECT_EQ(static_cast<std::int32_t>(input(3, 2)), 300'000);
    ASSERT_EQ(command(0x0102, 0), Verdict::good);
    w.run_for(1s);
    EXPECT_EQ(increments(), 3000) << "the same count is no new command";
    ASSERT_EQ(command(0x0113, -100'000), Verdict::good) << "by an increment of the demand position";
    ASSERT_TRUE(until([&] { return increments() == 2000; })) << increments();
    w.run_for(500ms);
    ASSERT_EQ(command(0x0104, 10'000'000), Verdict::good);
    ASSERT_TRUE(until([&] { return speed(a1) > 2000; }, 5s));
    ASSERT_EQ(write(0, {0x002F}), Verdict::good) << "abort";
    EXPECT_EQ(input(0) >> 8, 12u);
    ASSERT_TRUE(until([&] { return speed(a1) == 0; }, 10s));
    ASSERT_EQ(write(0, {0x003F}), Verdict::good);
    EXPECT_EQ(input(0) >> 8, 8u);
    ASSERT_EQ(command(0x0405, 1), Verdict::good) << "a curve";
    EXPECT_EQ(input(0), 0x0481u) << "unknown motion command";
    ASSERT_EQ(write(0, {0x00BF}), Verdict::good) << "acknowledged";
    EXPECT_EQ(input(0) >> 8, 0u);
    ASSERT_EQ(write(0, {0x003E}), Verdict::good);
    EXPECT_TRUE(until([&] { return power_state_of(now().statusword) != PowerState::operation_enabled; }, 10s));
}
TEST_P(ProfileLaws, ALinMotProgramMovesTheAxis) { play_linmot(Way::modbus); }
TEST_P(ProfileLaws, ALinMotProgramMovesTheAxisByItsImage) { play_linmot(Way::image); }

void ProfileLaws::play_block(Way by) {
    speak(ProfileLanguage::cia402, by);
    for (const auto cw : {std::uint16_t{0x0006}, std::uint16_t{0x0007}, std::uint16_t{0x000F}}) {
        ASSERT_EQ(write(32, {cw}), Verdict::good);
        w.run_for(500ms);
    }
    ASSERT_TRUE(until([&] { return (holding(0) & 0x6F) == 0x27; }, 10s));
    const auto one = image->read(1, Table::holding_registers, 0, 12), here = image->read(unit, Table::holding_registers, 0, 12);
    EXPECT_EQ(one.bytes, here.bytes);
    EXPECT_EQ(image->read(unit, Table::holding_registers, 60, 5).verdict, Verdict::no_address);
}
TEST_P(ProfileLaws, TheBlockOfCia402IsAWindowOnUnitOne) { play_block(Way::modbus); }
TEST_P(ProfileLaws, TheBlockOfCia402IsAWindowOnUnitOneByItsImage) { play_block(Way::image); }

INSTANTIATE_TEST_SUITE_P(Families, ProfileLaws, testing::ValuesIn(subjects()), name_of_subject);
INSTANTIATE_TEST_SUITE_P(Families, LexiumScript, testing::ValuesIn(subjects()), name_of_subject);
INSTANTIATE_TEST_SUITE_P(Families, PaControlScript, testing::ValuesIn(subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
