// The axes behind the EtherNet/IP objects: assemblies byte for byte, commands with their client, losses with their cause, parameters.
#include "gateway/doors/enip/axis_values.hpp"

#include <gtest/gtest.h>

#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/protocols/cip/adapter.hpp"
#include "gateway/protocols/cip/eds.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::enip {
namespace {
using cip::Bytes;
using cip::General;
using namespace std::chrono_literals;

constexpr const char* page = R"({"family": "test", "number": 9, "parameters": [
 {"id": "AC", "name": "acceleration", "group": "g", "type": "u32", "unit": "pulse/s^2", "min": 1, "max": 65000, "default": 100, "access": "RW", "storage": "ram", "description": "Ramp"},
 {"id": "V", "name": "version", "group": "g", "type": "text", "unit": null, "min": null, "max": null, "default": null, "access": "R", "storage": "rom", "description": "Of the firmware"}],
 "commands": [], "errors": []})";

struct Port final : modbus::test::FakePort {
    void client_lost(const AuthorityClient& who, LossCause cause) override { lost.emplace_back(who.text(), cause); }
    std::optional<Refusal> set_point(const SetPoint& p) override {
        points.push_back(p);
        return std::nullopt;
    }
    /// Leases are recorded separately, because every running owner causes them.
    void submit(Command c) override {
        if (std::holds_alternative<HoldAxis>(c.body)) return leases.push_back(std::move(c));
        FakePort::submit(std::move(c));
    }
    std::vector<Command> leases;
    std::vector<std::pair<std::string, LossCause>> lost;
    std::vector<SetPoint> points;
};

struct AxisValuesBench final : HotDoor {
    AxisValuesBench() {
        std::vector<std::string> faults;
        catalogue = Catalogue::parse(page, faults);
        EXPECT_TRUE(catalogue) << (faults.empty() ? "" : faults[0]);
        one = port.add_axis(1, &*catalogue);
        three = port.add_axis(3, &*catalogue);
        far = port.add_axis(41, &*catalogue);
        values.use_number(port.attach(*this));
        values.use([this](cip::Token t, General g, cip::View v, std::uint16_t x) {
            published.push_back({t, g, Bytes(v.begin(), v.end()), x});
        });
        std::vector<LayoutAxis> axes{{41, far, "far", &*catalogue}, {1, one, "feeder", &*catalogue}, {3, three, "slide", &*catalogue}};
        values.use(Layout(std::move(axes), 0x12345678, {}));
    }
    std::span<const WayIn> ways_in() const override { return enip::ways_of_clients; }
    std::string_view name() const override { return "enip"; }
    void on_result(const Result& r) override { values.on_result(r); }

    std::optional<Catalogue> catalogue;
    Port port;
    registers::RegisterImage image{port, {}};
    AxisValues values{port, image, 30};
    AxisId one{}, three{}, far{};
    struct Published {
        cip::Token token;
        General general;
        Bytes value;
        std::uint16_t extended = 0;
    };
    std::vector<Published> published;
    cip::Peer plc{{0xC0000207, 50'000}, 1};
};

TEST(EnipAxisValues, AssembliesHaveTheNumbersOfTheirAxes) {
    AxisValuesBench d;
    EXPECT_EQ(d.values.assemblies(), (std::vector<std::uint32_t>{100, 101, 103, 150, 151, 153, 197, 198, 199, 1041, 2041}));
    EXPECT_EQ(d.values.assembly(103)->size, 32);
    EXPECT_EQ(d.values.assembly(100)->size, 41 * 32);
    EXPECT_FALSE(d.values.assembly(102));
    EXPECT_EQ(d.values.assembly(2041)->role, cip::AssemblyInfo::Role::output);
    EXPECT_TRUE(d.values.overlap(150, 153));
    EXPECT_FALSE(d.values.overlap(151, 153));
}

TEST(EnipAxisValues, InputsAreTheRegistersLittleEndian) {
    AxisValuesBench d;
    d.port.edit(d.three, [](AxisPicture& p) {
        p.statusword = 0x1637;
        p.mode_display = 3;
        p.position = -2;
        p.velocity = 0x01020304;
        p.flags = 0x0005;
        p.family_number = 7;
    });
    Bytes b;
    d.values.read(103, d.port.now(), b);
    ASSERT_EQ(b.size(), 32u);
    EXPECT_EQ(Bytes(b.begin(), b.begin() + 12), (Bytes{0x37, 0x16, 3, 0, 0xFE, 0xFF, 0xFF, 0xFF, 4, 3, 2, 1}));
    EXPECT_EQ(b[18], 5);
    EXPECT_EQ(b[30], 7);
    Bytes all;
    d.values.read(100, d.port.now(), all);
    ASSERT_EQ(all.size(), 41u * 32u);
    EXPECT_EQ(Bytes(all.begin() + 64, all.begin() + 96), b);
    EXPECT_EQ(Bytes(all.begin() + 32, all.begin() + 64), Bytes(32)) << "no axis has the number 2";
}

TEST(EnipAxisValues, AnOwnersEdgeIsACommandOfItsClient) {
    AxisValuesBench d;
    d.values.opened(153, d.plc, 40ms, d.port.now());
    Bytes out(32);
    d.values.consumed(153, out, d.plc, d.port.now());
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(std::get<ProcessData>(d.port.commands.front().body).controlword, 0)
        << "what was sent last is not known: zeros are a word, too";
    d.port.answer();
    out[0] = 0x0F;
    d.values.consumed(153, out, d.plc, d.port.now());
    ASSERT_EQ(d.port.commands.size(), 1u);
    const Command& c = d.port.commands.front();
    EXPECT_EQ(c.axis, d.three);
    EXPECT_EQ(std::get<ProcessData>(c.body).controlword, 0x0F);
    EXPECT_EQ(AuthorityClient::of(c.origin).text(), "ethernet_ip 192.0.2.7 assembly 153");
    d.port.edit(d.three, [](AxisPicture& p) { p.statusword = 0x27; });
    out[2] = 8;
    out[4] = 100;
    d.values.consumed(153, out, d.plc, d.port.now());
    ASSERT_EQ(d.port.points.size(), 1u);
    EXPECT_EQ(d.port.points[0].value, 100);
    EXPECT_EQ(d.port.points[0].good_for, Duration(40ms)) << "its time-out is the connection's";
}

TEST(EnipAxisValues, EachEndOfAConnectionHasItsCause) {
    AxisValuesBench d;
    const auto end = [&](auto how) {
        d.values.opened(151, d.plc, 40ms, d.port.now());
        how();
        return d.port.lost.back().second;
    };
    EXPECT_EQ(end([&] { d.values.idle(151, d.plc, d.port.now()); }), enip::loss_idle);
    EXPECT_EQ(end([&] { d.values.ended(151, d.plc, cip::End::timed_out, d.port.now()); }), enip::loss_timed_out);
    EXPECT_EQ(end([&] { d.values.ended(151, d.plc, cip::End::closed, d.port.now()); }), enip::loss_closed);
    EXPECT_EQ(end([&] { d.values.ended(151, d.plc, cip::End::by_gateway, d.port.now()); }), enip::loss_closed);
    EXPECT_EQ(d.port.lost.back().first, "ethernet_ip 192.0.2.7 assembly 151");
    EXPECT_NE(d.port.notes.back().first.text.find("site was changed"), std::string::npos);
}

TEST(EnipAxisValues, WhoHoldsTheAxisKeepsOthersOut) {
    AxisValuesBench d;
    d.port.time += 1s;
    d.port.edit(d.one, [&](AxisPicture& p) {
        p.authority = http::clients;
        p.authority_until = d.port.now() + 10s;
        std::snprintf(p.authority_holder.data(), p.authority_holder.size(), "anne");
    });
    EXPECT_TRUE(d.values.held_by_another(151, d.plc, d.port.now()));
    EXPECT_TRUE(d.values.held_by_another(150, d.plc, d.port.now()));
    EXPECT_FALSE(d.values.held_by_another(153, d.plc, d.port.now()));
    EXPECT_FALSE(d.values.held_by_another(151, d.plc, d.port.now() + 10s)) << "its lease is over";
    d.port.edit(d.one, [](AxisPicture& p) {
        p.authority = enip::clients;
        std::snprintf(p.authority_holder.data(), p.authority_holder.size(), "192.0.2.7 assembly 151");
    });
    EXPECT_FALSE(d.values.held_by_another(151, d.plc, d.port.now())) << "it is this client itself";
}

TEST(EnipAxisValues, AnOwnerInRunModeHoldsItsAxisAndLetsItGo) {
    AxisValuesBench d;
    d.port.time += 1s;
    const auto kinds = [&] {
        std::vector<HoldAxis::Kind> list;
        for (const auto& c : std::exchange(d.port.leases, {}))
            list.push_back(std::get<HoldAxis>(c.body).kind);
        return list;
    };
    using Kinds = std::vector<HoldAxis::Kind>;
    using enum HoldAxis::Kind;
    const auto holds = [&](Door door, const char* who) {
        d.port.edit(d.one, [&](AxisPicture& p) {
            p.authority = door;
            p.authority_until = d.port.now() + 30s;
            std::snprintf(p.authority_holder.data(), p.authority_holder.size(), "%s", who);
        });
    };
    d.values.opened(151, d.plc, 40ms, d.port.now());
    d.values.sweep(d.port.now());
    EXPECT_EQ(kinds(), Kinds{}) << "not in run mode yet";
    d.values.consumed(151, Bytes(32), d.plc, d.port.now());
    EXPECT_EQ(kinds(), Kinds{take});
    holds(enip::clients, "192.0.2.7 assembly 151");
    d.port.time += 5s;
    d.values.sweep(d.port.now());
    EXPECT_EQ(kinds(), Kinds{take}) << "who goes on holds on";
    holds(http::clients, "anne");
    d.port.time += 5s;
    d.values.sweep(d.port.now());
    EXPECT_EQ(kinds(), Kinds{}) << "taken over: it is anne's for her time";
    d.port.time += 31s;
    d.values.sweep(d.port.now());
    EXPECT_EQ(kinds(), Kinds{take}) << "and his again";
    d.values.idle(151, d.plc, d.port.now());
    EXPECT_EQ(kinds(), Kinds{release});
    d.values.consumed(151, Bytes(32), d.plc, d.port.now());
    d.values.ended(151, d.plc, cip::End::closed, d.port.now());
    EXPECT_EQ(kinds(), (Kinds{take, release}));
}

TEST(EnipAxisValues, WhoCommandsByMessagesIsLostWithHisLastWay) {
    using Lost = std::vector<std::pair<std::string, LossCause>>;
    const Lost gone{{"ethernet_ip 192.0.2.7", enip::loss_session_closed}};
    AxisValuesBench d;
    const cip::Peer unconnected{{0xC0000207, 50'000}, 0, 5}, connected{{0xC0000207, 50'000}, 9, 5}, other{{0xC0000207, 50'001}, 0, 6};
    bool later = false;
    cip::Token token = 1;
    const auto write = [&](const cip::Peer& by) {
        EXPECT_EQ(d.values.write(151, Bytes(32), token++, by, d.port.now(), later), General::success);
        d.port.answer();
    };
    EXPECT_EQ(d.values.ask(3, 77, other, d.port.now()), General::success) << "who asks does not command";
    write(unconnected);
    write(connected);
    EXPECT_TRUE(later);
    EXPECT_TRUE(d.values.commands_by(5));
    EXPECT_FALSE(d.values.commands_by(6));
    d.values.messages_ended(other);
    d.values.messages_ended(connected);
    EXPECT_EQ(d.port.lost, Lost{});
    d.values.messages_ended(unconnected);
    EXPECT_EQ(d.port.lost, gone);
    d.values.messages_ended(unconnected);
    EXPECT_EQ(d.port.lost, gone) << "once";
    // Each way of commanding by messages: an output, a parameter.
    d.port.lost.clear();
    EXPECT_EQ(d.values.set(3, Bytes{1, 0, 0, 0}, 78, other, d.port.now()), General::success);
    d.values.messages_ended(other);
    EXPECT_EQ(d.port.lost, gone) << "told at once";
    while (d.port.answer()) {
    }
    ASSERT_EQ(d.port.lost.size(), 2u) << "and again when the command that was on its way has been answered: it may have begun a motion";
    // The owner's own messages belong to the owner.
    d.port.lost.clear();
    d.values.opened(151, d.plc, 40ms, d.port.now());
    EXPECT_EQ(d.values.set(1, Bytes{1, 0, 0, 0}, 79, unconnected, d.port.now()), General::success);
    EXPECT_EQ(AuthorityClient::of(d.port.commands.back().origin).text(), "ethernet_ip 192.0.2.7 assembly 151");
    d.values.messages_ended(unconnected);
    EXPECT_EQ(d.port.lost, Lost{});
}

TEST(EnipAxisValues, AWrittenOutputIsAnsweredByWhatWasSaidOfIt) {
    AxisValuesBench d;
    const cip::Peer by{{0xC0000207, 50'000}, 0, 5};
    const std::pair<Reason, std::uint8_t> list[] = {{Reason::authority, 0x0C},     {Reason::out_of_range, 0x09},
                                                    {Reason::not_supported, 0x09}, {Reason::wrong_state, 0x10},
                                                    {Reason::busy, 0x02},          {Reason::no_answer, 0x07}};
    cip::Token token = 1;
    bool later = false;
    for (const auto& [reason, status] : list) {
        d.published.clear();
        EXPECT_EQ(d.values.write(151, Bytes(32), ++token, by, d.port.now(), later), General::success);
        EXPECT_TRUE(later && d.published.empty());
        d.port.refuse(reason);
        ASSERT_EQ(d.published.size(), 1u);
        EXPECT_EQ(static_cast<std::uint8_t>(d.published[0].general), status) << name_of(reason);
        EXPECT_EQ(d.published[0].extended, static_cast<std::uint16_t>(reason));
    }
    d.published.clear();
    EXPECT_EQ(d.values.write(150, Bytes(41 * 32), ++token, by, d.port.now(), later), General::success);
    d.port.answer();
    d.port.refuse(Reason::authority);
    EXPECT_TRUE(d.published.empty()) << "the third axis has not answered";
    d.port.answer();
    ASSERT_EQ(d.published.size(), 1u);
    EXPECT_EQ(d.published[0].general, General::object_state_conflict) << "one that is refused is a refusal";
    EXPECT_EQ(d.values.write(151, Bytes(32), 0, by, d.port.now(), later), General::resource_unavailable) << "nothing can be answered later";
    EXPECT_NE(d.port.notes.size(), 0u) << "and each is an event";
}

TEST(EnipAxisValues, ParametersAreTheDrives) {
    AxisValuesBench d;
    ASSERT_EQ(d.values.parameters(), 6u);
    EXPECT_EQ(d.values.parameter(3)->name, "acceleration");
    EXPECT_EQ(d.values.parameter(3)->max, (Bytes{0xE8, 0xFD, 0, 0}));
    EXPECT_EQ(d.values.ask(3, 77, d.plc, d.port.now()), General::success);
    ASSERT_EQ(d.port.commands.size(), 1u);
    EXPECT_EQ(d.port.commands.front().axis, d.three);
    EXPECT_TRUE(d.published.empty());
    d.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{300}});
    ASSERT_EQ(d.published.size(), 1u);
    EXPECT_EQ(d.published[0].value, (Bytes{0x2C, 1, 0, 0}));
    EXPECT_EQ(d.values.set(3, Bytes{0, 0, 0, 0}, 78, d.plc, d.port.now()), General::invalid_attribute_value);
    EXPECT_EQ(d.values.set(3, Bytes{1, 0, 0, 0}, 78, d.plc, d.port.now()), General::success);
    d.port.refuse(Reason::authority);
    EXPECT_EQ(d.published[1].general, General::privilege_violation);
    EXPECT_EQ(d.values.ask(4, 79, d.plc, d.port.now()), General::success);
    d.values.sweep(d.port.now() + 31s);
    EXPECT_EQ(d.published[2].general, General::connection_lost) << "no answer in time";
}

TEST(EnipAxisValues, EachReasonOfADriveHasItsGeneralStatus) {
    const std::pair<Reason, std::uint8_t> list[] = {
        {Reason::out_of_range, 0x09},  {Reason::unknown_point, 0x14}, {Reason::not_writable, 0x0E}, {Reason::wrong_state, 0x10},
        {Reason::not_supported, 0x14}, {Reason::drive_refused, 0x1F}, {Reason::busy, 0x02},         {Reason::line_down, 0x07},
        {Reason::no_answer, 0x07},     {Reason::interrupted, 0x10},   {Reason::authority, 0x0F},    {Reason::not_stored, 0x19},
        {Reason::internal, 0x1F},
    };
    AxisValuesBench d;
    cip::Token token = 100;
    for (const auto& [reason, status] : list) {
        EXPECT_EQ(d.values.set(3, Bytes{1, 0, 0, 0}, ++token, d.plc, d.port.now()), General::success);
        d.port.refuse(reason);
        EXPECT_EQ(static_cast<std::uint8_t>(d.published.back().general), status) << name_of(reason);
        EXPECT_EQ(d.published.size(), token - 100);
    }
    EXPECT_EQ(d.values.ask(3, ++token, d.plc, d.port.now()), General::success);
    d.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{1} << 40});
    EXPECT_EQ(d.published.back().general, General::no_stored_data) << "what the drive told is no number of the parameter's type";
}

TEST(EnipAxisValues, AnotherLayoutIsTheSameDevice) {
    const Layout a({}, 1, {}), b({}, 2, {});
    EXPECT_EQ(std::pair(a.device().major, a.device().minor), std::pair(b.device().major, b.device().minor));
    EXPECT_NE(a.device().consistency, b.device().consistency);
}

TEST(EnipAxisValues, AssembliesAreTheSameWhileTheirOwnBytesAre) {
    const AxisId one{1}, two{2}, anew{3};
    const Layout before({{1, one, "feeder"}, {2, two, "slide"}}, 1, {}), other_hash({{1, one, "feeder"}, {2, two, "slide"}}, 2, {}),
        made_anew({{1, one, "feeder"}, {2, anew, "slide"}}, 3, {}),
        grown({{1, one, "feeder"}, {2, two, "slide"}, {3, anew, "lift"}}, 4, {});
    for (const std::uint32_t i : before.assemblies())
        EXPECT_TRUE(before.same_bytes(i, other_hash)) << i;
    for (const std::uint32_t i : {101u, 151u, 197u, 198u, 199u}) {
        EXPECT_TRUE(before.same_bytes(i, made_anew)) << i;
        EXPECT_TRUE(before.same_bytes(i, grown)) << i;
    }
    for (const std::uint32_t i : {100u, 150u, 102u, 152u})
        EXPECT_FALSE(before.same_bytes(i, made_anew)) << i;
    EXPECT_FALSE(before.same_bytes(100, grown)) << "it is longer";
    EXPECT_TRUE(before.same_bytes(102, grown));
    EXPECT_FALSE(grown.same_bytes(103, before)) << "it is gone";
}

/// The view of a tool: entries of the EDS, each a list of fields.
std::map<std::string, std::vector<std::string>> read_eds(const std::string& text) {
    std::map<std::string, std::vector<std::string>> entries;
    std::string clean;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find("\r\n", at);
        std::string line = text.substr(at, end - at);
        if (!line.starts_with('$') && !line.starts_with('[')) clean += line;
        at = end + 2;
    }
    std::string field;
    std::vector<std::string> fields;
    std::string key;
    bool quoted = false;
    const auto trimmed = [](const std::string& s) {
        const auto from = s.find_first_not_of(' ');
        return from == std::string::npos ? std::string() : s.substr(from, s.find_last_not_of(' ') + 1 - from);
    };
    for (const char c : clean) {
        if (c == '"') quoted = !quoted;
        if (!quoted && c == '=' && key.empty()) {
            key = trimmed(field);
            field.clear();
        } else if (!quoted && (c == ',' || c == ';')) {
            fields.push_back(trimmed(field));
            field.clear();
            if (c == ';') entries[std::exchange(key, {})] = std::exchange(fields, {});
        } else {
            field += c;
        }
    }
    return entries;
}
Bytes bytes_of(const std::string& quoted) {
    Bytes out;
    for (std::size_t i = 1; i + 2 <= quoted.size() - 1; i += 3)
        out.push_back(static_cast<std::uint8_t>(std::stoi(quoted.substr(i, 2), nullptr, 16)));
    return out;
}

struct Nowhere final : cip::Output {
    void implicit(cip::Endpoint, cip::View, std::uint8_t) override {}
    void stream(cip::SessionKey, cip::View b) override { last.assign(b.begin(), b.end()); }
    void datagram(cip::Endpoint, cip::View) override {}
    void hang_up(cip::SessionKey) override {}
    Bytes last;
};

TEST(EnipEds, SaysWhatTheAdapterSays) {
    AxisValuesBench d;
    cip::EdsNames names{"axisgate", "Communications Adapter", "axisgate", [&](auto i) { return d.values.layout().name_of(i); },
                        [&](auto i) { return d.values.layout().place_of(i).axis->name + " " + d.values.parameter(i)->name; }};
    const std::string text = cip::eds_text(d.values.layout(), names);
    for (const char c : text)
        ASSERT_TRUE((c >= 0x20 && c < 0x7F) || c == '\r' || c == '\n');
    auto eds = read_eds(text);
    Nowhere out;
    cip::Adapter adapter(d.values, out, 1);
    ASSERT_TRUE(adapter.on_connected(1, d.plc.from, d.port.now()));
    cip::Header h;
    h.command = 0x65;
    adapter.on_stream(1, cip::packet(h, Bytes{1, 0, 0, 0}), d.port.now());
    h.session = cip::read_header(out.last).session;
    h.command = 0x6F;
    const auto ask = [&](const Bytes& message) {
        Bytes body(6);
        cip::put16(body, 2);
        cip::put_item(body, cip::item::null_address, {});
        cip::put_item(body, cip::item::unconnected_data, message);
        adapter.on_stream(1, cip::packet(h, body), d.port.now());
        const auto items = cip::read_items(cip::View(out.last).subspan(cip::header_size + 6));
        return cip::read_answer(items->list[1].data).value();
    };
    const auto single = [&](std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute) {
        Bytes path;
        cip::put_class(path, class_id);
        cip::put_instance(path, instance);
        cip::put_attribute(path, attribute);
        return ask(cip::request(cip::service::get_single, path)).data;
    };
    const auto number = [](const Bytes& b) {
        std::uint32_t n = 0;
        for (std::size_t i = b.size(); i-- > 0;)
            n = n << 8 | b[i];
        return std::to_string(n);
    };
    EXPECT_EQ(eds["VendCode"][0], number(single(1, 1, 1)));
    EXPECT_EQ(eds["ProdType"][0], number(single(1, 1, 2)));
    EXPECT_EQ(eds["ProdCode"][0], number(single(1, 1, 3)));
    EXPECT_EQ(eds["MajRev"][0], std::to_string(single(1, 1, 4)[0]));
    EXPECT_EQ(eds["MinRev"][0], std::to_string(single(1, 1, 4)[1]));
    EXPECT_EQ(eds["MaxInst"].size(), 1u);
    int assemblies = 0, parameters = 0, connections = 0;
    for (const auto& [key, fields] : eds) {
        if (key.starts_with("Assem")) {
            ++assemblies;
            EXPECT_EQ(fields[2], number(single(4, static_cast<std::uint32_t>(std::stoi(key.substr(5))), 4))) << key;
        } else if (key.starts_with("Param") && std::isdigit(static_cast<unsigned char>(key[5]))) {
            ++parameters;
            const auto instance = static_cast<std::uint32_t>(std::stoi(key.substr(5)));
            EXPECT_EQ(std::stoul(fields[4], nullptr, 16), single(15, instance, 5)[0]) << key;
            EXPECT_EQ(std::to_string(single(15, instance, 6)[0]), fields[5]) << key;
            if (!fields[9].empty()) EXPECT_EQ(fields[9], number(single(15, instance, 10))) << key;
        } else if (key.starts_with("Connection") && std::isdigit(static_cast<unsigned char>(key[10]))) {
            ++connections;
            // Opened as a tool would open it, point to point.
            const bool header = (std::stoul(fields[1], nullptr, 16) >> 8 & 7) == 4;
            const auto consumed = static_cast<std::uint32_t>(std::stoul(fields[3])),
                       produced = static_cast<std::uint32_t>(std::stoul(fields[6]));
            const Bytes path = bytes_of(fields.back());
            Bytes open{10, 14};
            cip::put32(open, 0);
            cip::put32(open, 1);
            cip::put16(open, static_cast<std::uint16_t>(connections));
            cip::put16(open, 1);
            cip::put32(open, 1);
            cip::put32(open, 0);
            const bool listens = fields.end()[-3].find("Listen") != std::string::npos;
            for (const std::uint32_t size : {consumed + 2 + (header ? 4 : 0), produced + 2}) {
                cip::put32(open, 10'000);
                cip::put32(open, 0x48000000 | size);
            }
            cip::put8(open, 1);
            cip::put8(open, static_cast<std::uint8_t>(path.size() / 2));
            cip::put_bytes(open, path);
            const auto answer = ask(cip::request(cip::service::large_forward_open, Bytes{0x20, 6, 0x24, 1}, open));
            if (listens || answer.extended == std::vector<std::uint16_t>{0x0106}) continue;  // its owner does not exist, or is another one
            EXPECT_EQ(answer.general, General::success) << key << " " << text;
        }
    }
    EXPECT_EQ(assemblies, 11);
    EXPECT_EQ(parameters, 6);
    EXPECT_EQ(connections, 12);
    EXPECT_NE(text, cip::eds_text(Layout({{1, d.one, "feeder", &*d.catalogue}}, 7, {}), names));
}
}  // namespace
}  // namespace axisgate::enip
