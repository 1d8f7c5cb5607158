// Registers of the standard map, of a site's own map and of the four languages; EtherNet/IP messages and connections; commands, actions,
// statements, recipes, streams; programs and motions that no client of this gateway has begun.
#include "tests/conformance/ways.hpp"

#include <fstream>
#include <iterator>
#include <numeric>

#include "gateway/axis/cia402.hpp"
#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/registers/words.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
#include "gateway/services/recipes/recipe_run.hpp"

namespace axisgate::test {
namespace json = boost::json;
using namespace std::chrono_literals;
using registers::Table;
using registers::Verdict;

namespace {
Origin origin_of(Door door, const char* who) { return {door, std::make_shared<const std::string>(who), {}}; }
std::uint16_t high(std::int64_t v) { return static_cast<std::uint16_t>(static_cast<std::uint64_t>(v) >> 16); }
std::uint16_t low(std::int64_t v) { return static_cast<std::uint16_t>(v); }
}  // namespace

// --- the bench --------------------------------------------------------------------------------------------------------

Bench::Bench(const Subject& s, std::uint64_t seed, std::shared_ptr<Plant> plant) : subject(s), world(seed, std::move(plant)) {
    registers::RegisterImage::Settings settings;
    static const registers::Languages pages = languages();
    settings.languages = pages;
    image = std::make_unique<registers::RegisterImage>(port, settings);
    modbus = std::make_unique<WriterDoor>(port, *image);
    enip = std::make_unique<EnipDoor>(port, *image);
}
void Bench::use(std::shared_ptr<const SiteState> in_force) {
    site = std::move(in_force);
    axis = site->axis_ids.at(0);
    image->on_site(*site);
    enip->values.use(enip::Layout({{1, axis, "a1", world.engine.catalogue(axis)}}, 1, {}, enip::windows_of(*site),
                                  enip::objects_of(*site, image->languages())));
}
bool Bench::until(const std::function<bool()>& condition, Duration limit) {
    const auto met = [&] {
        port.deliver();
        return condition();
    };
    for (const Instant end = world.now + limit;;) {
        if (world.run_until_true(met, std::min<Duration>(10ms, end - world.now))) return true;
        if (world.now >= end) return false;
        if (meanwhile) meanwhile();
    }
}
void Bench::run(Duration time) {
    (void)until([] { return false; }, time);
}
Ticket Bench::give(CommandBody body, const Origin& by) {
    Command c;
    c.ticket = make_ticket(first_service_door, tickets++);
    c.axis = axis;
    c.body = std::move(body);
    c.origin = by;
    const Ticket t = c.ticket;
    world.engine.on_command(std::move(c), world.now);
    return t;
}
const Result* Bench::ask(CommandBody body, const Origin& by, Duration limit) {
    const Ticket t = give(std::move(body), by);
    (void)until([&] { return world.result(t) != nullptr; }, limit);
    return world.result(t);
}

const json::object& facts_of(const Subject& subject) {
    static std::map<std::string, json::object, std::less<>> kept;
    const std::string name(subject.family->name);
    auto& facts = kept[name];
    if (facts.empty()) {
        std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/" + name + "/tests/facts.json");
        facts = json::parse(std::string(std::istreambuf_iterator<char>(file), {})).get_object();
    }
    return facts;
}

namespace {

bool powered_on(Bench& b) {
    return b.until([&] { return b.enabled(); }, 10s);
}
/// One word of a controller that checks the status word before it writes the next one.
struct Step {
    std::uint16_t word;
    bool (*there)(PowerState);
    [[nodiscard]] bool follows(Bench& b) const {
        return b.until([&] { return there(b.state()); }, 10s);
    }
};
constexpr Step walk_up[]{
    {0x0000, [](PowerState s) { return s == PowerState::switch_on_disabled || s == PowerState::fault; }},
    {0x0080, [](PowerState s) { return s == PowerState::switch_on_disabled; }},
    {0x0006, [](PowerState s) { return s == PowerState::ready_to_switch_on; }},
    {0x0007, [](PowerState s) { return s == PowerState::switched_on; }},
    {0x000F, [](PowerState s) { return s == PowerState::operation_enabled; }},
};
/// The command by which a user enables the axis before a motion.
bool enable_by(Bench& b, const Origin& by) {
    const Result* r = b.ask(Enable{}, by);
    return r && good(*r) && powered_on(b);
}

// --- registers --------------------------------------------------------------------------------------------------------

class RegisterWay : public Way, public registers::WriteOwner {
public:
    [[nodiscard]] std::vector<LossCause> losses() const override { return {modbus::loss_closed, modbus::loss_silent}; }
    [[nodiscard]] const Origin& origin() const override { return plc_; }
    void lose(Bench& b, LossCause cause) override {
        silent = true;
        if (cause == modbus::loss_silent) return;  // World::received_at does not advance
        b.world.received_at.reset();
        b.world.engine.on_client_lost(AuthorityClient::of(plc_), cause, b.world.now);
    }
    void returned(Bench&) override { waiting_ = 0; }  // outstanding writes are not answered any more
    void on_written(std::uint8_t, AxisId, Verdict verdict) override {
        if (waiting_ > 0) --waiting_;
        if (verdict != Verdict::good) refused_ = "exception " + std::to_string(static_cast<int>(verdict));
    }
    [[nodiscard]] std::string refusal(const Bench&) const override { return refused_; }

protected:
    /// Writes registers from `address` on in one request. They count as its last words, which cycle() repeats.
    void send(Bench& b, std::uint16_t address, std::vector<std::uint16_t> values) {
        refused_.clear();
        last_ = {address, std::move(values)};
        write(b, last_.first, last_.second);
    }
    bool write(Bench& b, std::uint16_t address, const std::vector<std::uint16_t>& values) {
        registers::UnitMap* map = b.image->unit(unit());
        if (!map) return false;
        std::vector<std::uint8_t> data(2 * values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            registers::put16(data.data() + 2 * i, values[i]);
        b.world.received_at = b.world.now;
        const auto count = static_cast<std::uint16_t>(values.size());
        const auto begun =
            b.modbus->writer.write({this, plc_.who}, 0, *map, Table::holding_registers, address, count, data.data(), {}, b.world.now);
        if (begun.verdict != Verdict::good) {
            refused_ = "exception " + std::to_string(static_cast<int>(begun.verdict));
            return false;
        }
        waiting_ += begun.outstanding;
        return true;
    }
    bool say(Bench& b, std::uint16_t address, std::vector<std::uint16_t> values) {
        send(b, address, std::move(values));
        return b.until([&] { return waiting_ == 0; }, 20s) && refused_.empty();
    }
    [[nodiscard]] std::uint16_t read(Bench& b, Table table, std::uint16_t address) {
        b.port.deliver();
        const auto r = b.image->read(unit(), table, address, 1);
        return r.verdict == Verdict::good ? registers::get16(r.bytes.data()) : std::uint16_t{0};
    }
    void cycle(Bench& b) override {
        if (silent || last_.second.empty() || b.world.now < next_cycle_) return;
        next_cycle_ = b.world.now + period();
        const auto kept = refused_;
        (void)write(b, last_.first, last_.second);
        refused_ = kept;
    }
    [[nodiscard]] virtual std::uint8_t unit() const = 0;
    /// Period of its words.
    [[nodiscard]] virtual Duration period() const { return 100ms; }

    Origin plc_ = origin_of(modbus::clients, "192.0.2.7:50000");
    std::pair<std::uint16_t, std::vector<std::uint16_t>> last_;
    std::string refused_;
    int waiting_ = 0;
    Instant next_cycle_{};
};

/// Control word, mode, target position, profile velocity, acceleration and deceleration, target velocity: one block.
class BlockWay : public RegisterWay {
public:
    [[nodiscard]] bool prepare(Bench& b) override {
        words_ = {0, cia402::mode_profile_velocity, 0, speed, ramp, ramp, 0};
        for (const Step& step : walk_up) {
            words_.controlword = step.word;
            if (!say(b, address(), block())) return false;
            if (step.follows(b)) continue;
            refused_ = "the state does not follow word " + std::to_string(step.word);
            return false;
        }
        return powered_on(b);
    }
    void set_off(Bench& b) override { set_off_to(b, speed); }
    [[nodiscard]] bool takes_speeds() const override { return true; }
    void set_off_to(Bench& b, std::int64_t target) override {
        words_.velocity = target;
        send(b, address(), block());
    }

protected:
    [[nodiscard]] virtual std::uint16_t address() const { return registers::reg::controlword; }
    struct Words {
        std::uint16_t controlword = 0;
        std::int16_t mode = 0;
        std::int64_t position = 0, profile_velocity = 0, acceleration = 0, deceleration = 0, velocity = 0;
    };
    [[nodiscard]] std::vector<std::uint16_t> block() const {
        std::vector<std::uint16_t> out{words_.controlword, static_cast<std::uint16_t>(words_.mode)};
        for (const std::int64_t v : {words_.position, words_.profile_velocity, words_.acceleration, words_.deceleration, words_.velocity}) {
            out.push_back(high(v));
            out.push_back(low(v));
        }
        return out;
    }
    Words words_;
};
class StandardMapWay final : public BlockWay {
    [[nodiscard]] std::uint8_t unit() const override { return 1; }
};
class Cia402ProfileWay final : public BlockWay {
public:
    void fit(Site& site, const Subject&) const override {
        ProfileSpec spec;
        spec.unit = 10;
        spec.language = ProfileLanguage::cia402;
        spec.axes = {{"a1", std::nullopt, 40.0, 200.0}};
        site.profiles = {spec};
    }

private:
    [[nodiscard]] std::uint8_t unit() const override { return 10; }
};
/// A site's own map, written by a master on a serial line.
class OwnMapWay final : public BlockWay {
public:
    OwnMapWay() { plc_ = origin_of(modbus::clients, "serial:/dev/ttyS1"); }
    void fit(Site& site, const Subject&) const override {
        struct Row {
            AxisPoint point;
            const char* type;
            int registers;
        };
        int at = 100;
        json::array entries;
        for (const Row& r :
             {Row{AxisPoint::controlword, "u16", 1}, Row{AxisPoint::mode, "i16", 1}, Row{AxisPoint::target_position, "i32", 2},
              Row{AxisPoint::profile_velocity, "u32", 2}, Row{AxisPoint::profile_acceleration, "u32", 2},
              Row{AxisPoint::profile_deceleration, "u32", 2}, Row{AxisPoint::target_velocity, "i32", 2}}) {
            entries.push_back(json::value{{"unit", 20},
                                          {"table", "holding_registers"},
                                          {"address", at},
                                          {"axis", "a1"},
                                          {"point", name_of(r.point)},
                                          {"type", r.type},
                                          {"access", "read_write"}});
            at += r.registers;
        }
        std::vector<SiteFault> faults;
        auto parsed = parse_mappings(entries, site, families(), faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f.pointer << ": " << f.text;
        if (parsed) site.mappings = std::make_shared<const std::vector<Mapping>>(std::move(*parsed));
    }

private:
    [[nodiscard]] std::uint8_t unit() const override { return 20; }
    [[nodiscard]] std::uint16_t address() const override { return 100; }
};

class ProfileWay : public RegisterWay {
public:
    void fit(Site& site, const Subject&) const override {
        ProfileSpec spec;
        spec.unit = unit();
        spec.language = language();
        spec.axes = {{"a1", counts_per_unit(), 40.0, 200.0}};
        site.profiles = {spec};
    }

protected:
    [[nodiscard]] std::uint8_t unit() const override { return 10; }
    [[nodiscard]] virtual ProfileLanguage language() const = 0;
    [[nodiscard]] virtual std::optional<double> counts_per_unit() const { return {}; }
};

/// Each register of a Lexium drive is an instruction: SL turns at a speed.
class LexiumWay final : public ProfileWay {
public:
    [[nodiscard]] bool prepare(Bench& b) override {
        if (b.state() == PowerState::fault) {
            (void)say(b, error_, {0});
            if (!b.until([&] { return b.state() != PowerState::fault; }, 10s)) return false;
        }
        (void)say(b, enable_, {0});  // not every drive can be switched off
        if (!say(b, enable_, {1})) return false;
        if (!powered_on(b)) return false;
        return write32(b, speed_limit_, speed) && write32(b, acceleration_, ramp) && write32(b, deceleration_, ramp) &&
               write32(b, slew_, 0);
    }
    void set_off(Bench& b) override { set_off_to(b, speed); }
    [[nodiscard]] bool takes_speeds() const override { return true; }
    void set_off_to(Bench& b, std::int64_t target) override { send(b, slew_, words_of(b, target)); }

private:
    static constexpr std::uint16_t acceleration_ = 0, deceleration_ = 24, enable_ = 28, error_ = 33, slew_ = 120, speed_limit_ = 139;
    [[nodiscard]] ProfileLanguage language() const override { return ProfileLanguage::lexium; }
    [[nodiscard]] Duration period() const override { return 300ms; }  // each write is an instruction, so the period suits the slowest line
    static std::vector<std::uint16_t> words_of(Bench& b, std::int64_t v) {
        const auto& page = b.image->languages()[static_cast<std::size_t>(ProfileLanguage::lexium)];
        if (page->word_order == registers::WordOrder::high_first) return {high(v), low(v)};
        return {low(v), high(v)};
    }
    bool write32(Bench& b, std::uint16_t address, std::int64_t v) { return say(b, address, words_of(b, v)); }
};

/// Command header with a count; a motion to a position.
class LinMotWay final : public ProfileWay {
public:
    [[nodiscard]] bool endless() const override { return false; }
    [[nodiscard]] bool prepare(Bench& b) override {
        for (const int word : {0x003E, 0x00BE, 0x003E, 0x003F}) {
            if (!say(b, 0, {static_cast<std::uint16_t>(word)})) return false;
            b.run(200ms);
        }
        if (!b.until([&] { return read(b, Table::input_registers, 0) >> 8 == 8; }, 10s)) return false;
        return powered_on(b);
    }
    void set_off(Bench& b) override { set_off_to(b, b.picture().position + far); }
    void set_off_to(Bench& b, std::int64_t target) override {
        count_ = static_cast<std::uint16_t>((count_ + 1) % 16);
        const std::int64_t p = target * 100, v = 40'000, a = 20'000;  // 0.1 um; 1e-6 m/s, 1e-5 m/s^2
        send(b, 1, {static_cast<std::uint16_t>(0x0100 | count_), low(p), high(p), low(v), high(v), low(a), high(a), low(a), high(a)});
    }

    [[nodiscard]] std::string refusal(const Bench& b) const override {
        const auto r = b.image->read(unit(), Table::input_registers, 0, 1);
        if (!refused_.empty()) return refused_;
        return r.verdict == Verdict::good && registers::get16(r.bytes.data()) >> 8 == 4 ? "an error in the status word" : "";
    }

private:
    [[nodiscard]] ProfileLanguage language() const override { return ProfileLanguage::linmot; }
    [[nodiscard]] std::optional<double> counts_per_unit() const override { return 10'000; }
    std::uint16_t count_ = 0;
};

/// A command code with a toggling bit; a motion to a position.
class PaControlWay final : public ProfileWay {
public:
    [[nodiscard]] bool endless() const override { return false; }
    [[nodiscard]] bool prepare(Bench& b) override {
        // Out of ONLINE, where an error can be reset, and into it again; an unnecessary step is answered as an error.
        for (const std::uint16_t code : {std::uint16_t{0x0A81}, std::uint16_t{0x0909}, std::uint16_t{0x0603}})
            (void)command(b, code, 0, 0);
        if (!powered_on(b)) return false;
        if ((b.picture().flags & flag_referenced) == 0 && command(b, 0x0A83, 1, 0)) (void)command(b, 0x0A85, 1, 0);
        return true;  // not every drive can be given a reference here
    }
    void set_off(Bench& b) override { set_off_to(b, b.picture().position + far); }
    void set_off_to(Bench& b, std::int64_t target) override { begin(b, 0x0A87, 1, real_of(static_cast<float>(target) / 100.0F)); }

private:
    [[nodiscard]] ProfileLanguage language() const override { return ProfileLanguage::pacontrol; }
    static std::uint32_t real_of(float f) { return std::bit_cast<std::uint32_t>(f); }
    void begin(Bench& b, std::uint16_t code, std::uint16_t parameter, std::uint32_t data) {
        toggle_ = !toggle_;
        send(b, 0, {high(data), low(data), parameter, static_cast<std::uint16_t>(code | (toggle_ ? 0x8000 : 0))});
    }
    bool command(Bench& b, std::uint16_t code, std::uint16_t parameter, std::uint32_t data) {
        begin(b, code, parameter, data);
        const auto reply = [&] { return read(b, Table::input_registers, 3); };
        return b.until([&] { return (reply() & 0x6000) != 0; }, 10s) && (reply() & 0x4000) == 0;
    }
    [[nodiscard]] std::string refusal(const Bench& b) const override {
        const auto r = b.image->read(unit(), Table::input_registers, 3, 1);
        if (!refused_.empty()) return refused_;
        if (r.verdict != Verdict::good) return "";
        const unsigned reply = registers::get16(r.bytes.data());
        const bool of_the_last = ((reply & 0x8000) != 0) == toggle_;
        return of_the_last && (reply & 0x4000) ? "command error " + std::to_string(reply & 0x1FFF) : "";
    }
    bool toggle_ = false;
};

// --- EtherNet/IP ------------------------------------------------------------------------------------------------------

class EnipWay : public Way {
public:
    [[nodiscard]] const Origin& origin() const override { return plc_; }
    [[nodiscard]] bool prepare(Bench& b) override {
        words_ = {};
        words_.mode = cia402::mode_profile_velocity;
        words_.profile_velocity = speed;
        words_.profile_acceleration = words_.profile_deceleration = ramp;
        if (!open(b)) return false;
        words_.controlword = 0;
        send(b);
        b.run(50ms);
        for (const Step& step : walk_up) {
            words_.controlword = step.word;
            send(b);
            if (!step.follows(b)) return false;
        }
        return powered_on(b);
    }
    void set_off(Bench& b) override { set_off_to(b, speed); }
    [[nodiscard]] bool takes_speeds() const override { return true; }
    void set_off_to(Bench& b, std::int64_t target) override {
        words_.target_velocity = static_cast<std::int32_t>(target);
        send(b);
    }
    void cycle(Bench& b) override {
        if (!silent && b.world.now >= next_cycle_) send(b);
    }

protected:
    static constexpr std::uint32_t output = 151;
    virtual bool open(Bench& b) = 0;
    virtual void deliver(Bench& b, const cip::Bytes& bytes) = 0;
    void send(Bench& b) {
        next_cycle_ = b.world.now + 20ms;
        cip::Bytes bytes;
        cip::put16(bytes, words_.controlword);
        cip::put16(bytes, static_cast<std::uint16_t>(words_.mode));
        cip::put32(bytes, static_cast<std::uint32_t>(words_.target_position));
        cip::put32(bytes, words_.profile_velocity);
        cip::put32(bytes, words_.profile_acceleration);
        cip::put32(bytes, words_.profile_deceleration);
        cip::put32(bytes, static_cast<std::uint32_t>(words_.target_velocity));
        cip::put16(bytes, static_cast<std::uint16_t>(words_.homing_method));
        bytes.resize(enip::bytes_per_axis);
        deliver(b, bytes);
    }
    enip::Wanted words_;
    cip::Peer peer_{{0xC0000207, 50'000}, 0, 7};
    Origin plc_;
    Instant next_cycle_{};
};
/// Set_Attribute_Single to the output assembly, by a session.
class EnipMessageWay final : public EnipWay {
public:
    EnipMessageWay() { plc_ = origin_of(enip::clients, "192.0.2.7:50000"); }
    [[nodiscard]] std::vector<LossCause> losses() const override { return {enip::loss_session_closed, enip::loss_silent}; }
    void lose(Bench& b, LossCause cause) override {
        silent = true;
        if (cause == enip::loss_silent) return;  // World::received_at does not advance
        b.world.received_at.reset();
        b.enip->values.messages_ended(peer_);
    }
    [[nodiscard]] std::string refusal(const Bench& b) const override {
        return b.enip->published && *b.enip->published != cip::General::success ? "a bad status" : "";
    }

private:
    bool open(Bench&) override { return true; }
    void deliver(Bench& b, const cip::Bytes& bytes) override {
        bool later = false;
        b.world.received_at = b.world.now;
        b.enip->published.reset();
        const auto general = b.enip->values.write(output, bytes, ++token_, peer_, b.world.now, later);
        if (!later) b.enip->published = general;
        next_cycle_ = b.world.now + 100ms;
    }
    cip::Token token_ = 0;
};
/// An exclusive owner that sends its image every 20 ms.
class EnipOwnerWay final : public EnipWay {
public:
    EnipOwnerWay() {
        peer_.connection = 1;
        plc_ = enip::origin_of(output, peer_);
    }
    [[nodiscard]] std::vector<LossCause> losses() const override { return {enip::loss_closed, enip::loss_timed_out, enip::loss_idle}; }
    /// An owner is told by registers 20 and 21, which its input assembly may contain.
    void set_off_to(Bench& b, std::int64_t target) override {
        refusals_ = counted(b);
        EnipWay::set_off_to(b, target);
    }
    [[nodiscard]] std::string refusal(const Bench& b) const override {
        return counted(b) == refusals_ ? "" : "a refusal is counted in register 21";
    }
    void lose(Bench& b, LossCause cause) override {
        silent = true;
        if (cause == enip::loss_idle) return b.enip->values.idle(output, peer_, b.world.now);
        b.enip->values.ended(output, peer_, cause == enip::loss_closed ? cip::End::closed : cip::End::timed_out, b.world.now);
        opened_ = false;
    }

private:
    void returned(Bench& b) override {
        opened_ = false;
        (void)open(b);
    }
    bool open(Bench& b) override {
        if (!std::exchange(opened_, true)) b.enip->values.opened(output, peer_, 80ms, b.world.now);
        return true;
    }
    void deliver(Bench& b, const cip::Bytes& bytes) override {
        if (opened_) b.enip->values.consumed(output, bytes, peer_, b.world.now);
    }
    [[nodiscard]] static std::uint16_t counted(const Bench& b) {
        const auto r = b.image->read(1, Table::input_registers, registers::reg::refusals, 1);
        return r.verdict == Verdict::good ? registers::get16(r.bytes.data()) : std::uint16_t{0};
    }
    bool opened_ = false;
    std::uint16_t refusals_ = 0;
};

// --- commands ---------------------------------------------------------------------------------------------------------

class CommandWay : public Way {
public:
    [[nodiscard]] const Origin& origin() const override { return by_; }
    [[nodiscard]] std::string refusal(const Bench& b) const override {
        const Result* r = b.world.result(last_);
        return r && !good(*r) ? r->text : std::string();
    }

protected:
    Origin by_;
    Ticket last_ = no_ticket;
};

Move turning(std::int64_t speed) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = speed;
    m.acceleration = m.deceleration = Way::ramp;
    return m;
}

/// A page that holds the axis by a lease and renews it while it is open.
class HttpWay : public CommandWay {
public:
    HttpWay() { by_ = origin_of(http::clients, "anna"); }
    void fit(Site& site, const Subject&) const override { site.axes.at(0).authority_mode = AuthorityMode::lease; }
    [[nodiscard]] std::vector<LossCause> losses() const override { return {LossCause::lease_ended}; }
    [[nodiscard]] bool prepare(Bench& b) override {
        if (power_state_of(b.picture().statusword) == PowerState::fault) (void)b.ask(ResetFault{}, by_);
        return enable_by(b, by_);
    }
    void set_off(Bench& b) override { set_off_to(b, speed); }
    [[nodiscard]] bool takes_speeds() const override { return true; }
    void set_off_to(Bench& b, std::int64_t target) override { last_ = b.give(turning(target), by_); }
    void cycle(Bench& b) override {
        if (silent || b.world.now < next_cycle_) return;
        next_cycle_ = b.world.now + 500ms;
        HoldAxis keep;
        keep.lease_s = 1;
        (void)b.give(keep, by_);
    }
    void lose(Bench&, LossCause) override { silent = true; }

protected:
    Instant next_cycle_{};
};

/// The family's own command for a motion: by its name and argument, or in the drive's language.
class StatementWay : public HttpWay {
public:
    [[nodiscard]] bool endless() const override { return endless_; }
    void fit(Site& site, const Subject& s) const override {
        HttpWay::fit(site, s);
        const auto* ends = motion(s).if_contains("endless");
        endless_ = !ends || ends->as_bool();
    }
    [[nodiscard]] bool offered(const Subject& s, std::string& why) const override {
        const json::object& m = motion(s);
        if (const auto* lacks = m.if_contains("lacks")) return why = std::string(lacks->as_string()), false;
        return true;
    }
    [[nodiscard]] bool prepare(Bench& b) override {
        if (!HttpWay::prepare(b)) return false;
        const json::object& m = motion(b.subject);
        if (m.if_contains("here_is_zero") && (b.picture().flags & flag_referenced) == 0) {
            const Result* r = b.ask(SetPosition{0}, by_);
            if (!r || !good(*r)) return false;
        }
        if (const auto* before = m.if_contains("before")) {
            for (const auto& line : before->as_array()) {
                const Result* r = b.ask(body(line.as_object()), by_);
                if (!r || !good(*r)) return false;
            }
        }
        return true;
    }
    void set_off(Bench& b) override {
        const json::object& m = motion(b.subject);
        // In a language that counts its orders, the next one has another count.
        const char* const which = std::exchange(other_, !other_) && m.if_contains("begin_next") ? "begin_next" : "begin";
        last_ = b.give(m.if_contains("lacks") ? CommandBody{lacking()} : body(m.at(which).as_object()), by_);
    }
    [[nodiscard]] bool takes_speeds() const override { return false; }
    /// The statement with this index among those for extreme numbers.
    void set_off_to(Bench& b, std::int64_t number) override {
        last_ = b.give(body(motion(b.subject).at("ends").as_array().at(static_cast<std::size_t>(number)).as_object()), by_);
    }
    [[nodiscard]] std::vector<std::int64_t> ends(const Subject& s) const override {
        std::vector<std::int64_t> numbers(motion(s).at("ends").as_array().size());
        std::iota(numbers.begin(), numbers.end(), 0);
        return numbers;
    }

protected:
    mutable bool endless_ = true;
    bool other_ = false;
    [[nodiscard]] virtual const char* fact() const = 0;
    /// The request if the family's page has no such command.
    [[nodiscard]] virtual CommandBody lacking() const = 0;
    [[nodiscard]] const json::object& motion(const Subject& s) const {
        return facts_of(s).at("motions").as_object().at(fact()).as_object();
    }
    static CommandBody body(const json::object& o) {
        if (const auto* text = o.if_contains("send")) {
            const std::string_view s = text->as_string();
            return Native{{s.begin(), s.end()}, true};
        }
        Action a;
        a.name = std::string(o.at("action").as_string());
        if (const auto* argument = o.if_contains("argument")) a.argument = std::string(argument->as_string());
        return a;
    }
};
class NativeWay final : public StatementWay {
    [[nodiscard]] const char* fact() const override { return "native"; }
    /// The drive's own words may be a refusal: those that do not begin as the fact "done" says.
    [[nodiscard]] std::string refusal(const Bench& b) const override {
        const Result* r = b.world.result(last_);
        const auto* done = motion(b.subject).if_contains("done");
        const bool no = r && good(*r) && done && !std::string_view(r->text).starts_with(std::string_view(done->as_string()));
        return no ? "the drive answers " + r->text : StatementWay::refusal(b);
    }
    [[nodiscard]] CommandBody lacking() const override { return Native{{'m', 'o', 'v', 'e'}, true}; }
};
class ActionWay final : public StatementWay {
    [[nodiscard]] const char* fact() const override { return "action"; }
    [[nodiscard]] CommandBody lacking() const override { return Action{"move", "", {}}; }
};
class ProgramWay final : public StatementWay {
    [[nodiscard]] const char* fact() const override { return "program"; }
    [[nodiscard]] CommandBody lacking() const override { return Action{"program.of_none", "", {}}; }
};

/// A run of a recipe, which waits for its motion and stops it when it is cancelled.
class RecipeWay final : public HttpWay {
public:
    RecipeWay() { by_ = origin_of(http::clients, "recipe demo"); }
    [[nodiscard]] bool takes_speeds() const override { return false; }
    void fit(Site&, const Subject&) const override {}
    [[nodiscard]] std::vector<LossCause> losses() const override { return {LossCause::none}; }
    void set_off_to(Bench& b, std::int64_t target) override {
        const json::value page{{"steps",
                                {{{"command", {{"axis", "a1"}, {"command", "move_velocity"}, {"velocity", target}}}},
                                 {{"wait_s", 60}},
                                 {{"command", {{"axis", "a1"}, {"command", "move_velocity"}, {"velocity", target}}}}}}};
        std::vector<SiteFault> faults;
        auto recipe = read_recipe(page.as_object(), nullptr, faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f.pointer << ": " << f.text;
        if (!recipe) return;
        target_ = target;
        run_ = std::make_unique<RecipeRun>(std::move(*recipe), b.world.now);
        turn(b);
    }
    void cycle(Bench& b) override {
        if (run_) turn(b);
    }
    void lose(Bench& b, LossCause) override {
        silent = true;
        if (run_) (void)run_->cancel("its page was closed");
        turn(b);
    }

private:
    struct Looking final : RecipeWorld {
        [[nodiscard]] Value point(std::string_view, const AxisPointRow&) const override { return {}; }
    };
    void turn(Bench& b) {
        if (!run_) return;
        for (auto it = asked_.begin(); it != asked_.end();) {
            const Result* r = b.world.result(it->second);
            if (!r) {
                ++it;
                continue;
            }
            run_->answer(it->first, {good(*r), r->text});
            it = asked_.erase(it);
        }
        std::vector<RecipeRequest> requests;
        run_->turn(b.world.now, Looking{}, requests);
        for (const auto& q : requests) {
            const bool stop = q.what == RecipeRequest::What::stop;
            asked_[q.number] = last_ = b.give(stop ? CommandBody{Halt{}} : CommandBody{turning(target_)}, by_);
        }
    }
    std::unique_ptr<RecipeRun> run_;
    std::map<std::uint32_t, Ticket> asked_;
    std::int64_t target_ = 0;
};

/// A peer on the data bus whose end the reader reports.
class DdsWay final : public HttpWay {
public:
    DdsWay() { by_ = origin_of(dds::clients, "yard anna"); }
    void fit(Site&, const Subject&) const override {}
    void cycle(Bench&) override {}
    [[nodiscard]] std::vector<LossCause> losses() const override { return {dds::loss_deadline}; }
    void lose(Bench& b, LossCause cause) override {
        silent = true;
        b.world.engine.on_client_lost(AuthorityClient::of(by_), cause, b.world.now);
    }
};

// --- streams ----------------------------------------------------------------------------------------------------------

class StreamWay : public CommandWay {
public:
    StreamWay(SetPoint::Mode mode, Origin by) : mode_(mode) { by_ = std::move(by); }
    [[nodiscard]] bool offered(const Subject& s, std::string& why) const override {
        why = "the drive does not follow such set-points";
        return s.catalogue->offers_mode(cia402::mode_of(mode_)) ||
               (cia402::older_mode_of(mode_) != cia402::mode_none && s.catalogue->offers_mode(cia402::older_mode_of(mode_)));
    }
    [[nodiscard]] std::vector<LossCause> losses() const override {
        return {by_.door == dds::clients ? dds::loss_deadline : LossCause::set_points_silent};
    }
    [[nodiscard]] bool prepare(Bench& b) override {
        running_ = false;
        if (power_state_of(b.picture().statusword) == PowerState::fault) (void)b.ask(ResetFault{}, by_);
        b.run(600ms);  // a stream that was ended begins again only after a pause
        return enable_by(b, by_);
    }
    void set_off(Bench& b) override {
        from_ = b.picture().position;
        begun_ = b.world.now;
        fixed_.reset();
        running_ = true;
        say(b);
    }
    void set_off_to(Bench& b, std::int64_t target) override {
        set_off(b);
        fixed_ = target;
        say(b);
    }
    void cycle(Bench& b) override {
        if (!silent && running_) say(b);
    }
    void lose(Bench&, LossCause) override { silent = true; }
    [[nodiscard]] std::string refusal(const Bench&) const override { return refused_; }

private:
    void say(Bench& b) {
        SetPoint p;
        p.axis = b.axis;
        p.mode = mode_;
        const double passed = seconds(b.world.now - begun_);
        p.value = fixed_                              ? *fixed_
                  : mode_ == SetPoint::Mode::position ? from_ + static_cast<std::int64_t>(static_cast<double>(speed) * (passed + 0.1))
                  : mode_ == SetPoint::Mode::velocity ? speed
                                                      : 300;
        if (mode_ == SetPoint::Mode::position) p.velocity = 2 * speed;
        if (mode_ != SetPoint::Mode::torque) p.acceleration = p.deceleration = ramp;
        p.good_for = 200ms;
        p.at = b.world.now;
        p.origin = by_;
        const auto no = b.world.engine.on_set_point(p, b.world.now);
        refused_ = no ? no->text : "";
    }
    SetPoint::Mode mode_;
    std::int64_t from_ = 0;
    Instant begun_{};
    std::optional<std::int64_t> fixed_;
    bool running_ = false;
    std::string refused_;
};

/// It moved before this gateway existed: another gateway had ordered it, and is gone.
class FoundWay final : public HttpWay {
public:
    FoundWay() { by_ = origin_of(http::clients, "the gateway before"); }
    void fit(Site&, const Subject&) const override {}
    [[nodiscard]] bool unowned() const override { return true; }
    void cycle(Bench&) override {}
    [[nodiscard]] std::vector<LossCause> losses() const override { return {LossCause::motion_unowned}; }
};

template <class W>
std::unique_ptr<Way> made() {
    return std::make_unique<W>();
}
template <SetPoint::Mode mode, Door door>
std::unique_ptr<Way> made_stream() {
    return std::make_unique<StreamWay>(mode, origin_of(door, "anna"));
}

}  // namespace

const std::vector<WayKind>& ways_in() {
    using Mode = SetPoint::Mode;
    static const std::vector<WayKind> all{
        {"modbus", "modbus_tcp", made<StandardMapWay>},
        {"modbus_own_map", "modbus_rtu", made<OwnMapWay>},
        {"profile_cia402", "modbus_tcp", made<Cia402ProfileWay>},
        {"profile_lexium", "modbus_tcp", made<LexiumWay>},
        {"profile_linmot", "modbus_tcp", made<LinMotWay>},
        {"profile_pacontrol", "modbus_tcp", made<PaControlWay>},
        {"enip_message", "enip_messages", made<EnipMessageWay>},
        {"enip_owner", "enip_implicit", made<EnipOwnerWay>},
        {"http", "http_commands", made<HttpWay>},
        {"action", "http_commands", made<ActionWay>},
        {"native", "http_commands", made<NativeWay>},
        {"recipe", "recipes", made<RecipeWay>},
        {"dds", "dds_commands", made<DdsWay>},
        {"stream_position", "http_set_points", made_stream<Mode::position, http::clients>},
        {"stream_velocity", "dds_set_points", made_stream<Mode::velocity, dds::clients>},
        {"stream_torque", "http_set_points", made_stream<Mode::torque, http::clients>},
        {"program", "", made<ProgramWay>},
        {"found", "", made<FoundWay>},
    };
    return all;
}

}  // namespace axisgate::test
