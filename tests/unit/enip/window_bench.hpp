// A site with two axes, own assemblies and profiles, and the door's values for it, without sockets and engine.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/doors/enip/words.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::enip {
using cip::Bytes;
using cip::General;
using namespace std::chrono_literals;

inline constexpr const char* window_page = R"({"family": "test", "number": 9, "parameters": [
 {"id": "AC", "name": "acceleration", "group": "g", "type": "u32", "min": 1, "max": 65000, "access": "RW", "description": "Ramp"},
 {"id": "V", "name": "version", "group": "g", "type": "text", "access": "R", "description": "Of the firmware"}],
 "commands": [], "errors": []})";

struct WindowPort final : modbus::test::FakePort {
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
    std::vector<SetPoint> points;
};

struct WindowBench : HotDoor {
    WindowBench() {
        std::vector<std::string> faults;
        catalogue = Catalogue::parse(window_page, faults);
        EXPECT_TRUE(catalogue) << (faults.empty() ? "" : faults[0]);
        one = port.add_axis(1, &*catalogue);
        two = port.add_axis(2, &*catalogue);
        values.use_number(port.attach(*this));
        values.use([this](cip::Token t, General g, cip::View v, std::uint16_t) { published.push_back({t, g, Bytes(v.begin(), v.end())}); });
        state.axis_ids = {one, two};
        state.site.axes.resize(2);
        state.site.axes[0].name = "feeder";
        state.site.axes[0].number = 1;
        state.site.axes[1].name = "slide";
        state.site.axes[1].number = 2;
        for (const AxisId id : {one, two})
            port.edit(id, [](AxisPicture& p) { p.flags = flag_online | flag_referenced; });
    }
    std::span<const WayIn> ways_in() const override { return enip::ways_of_clients; }
    std::string_view name() const override { return "enip"; }
    void on_result(const Result& r) override { values.on_result(r); }

    static registers::Languages languages() {
        registers::Languages all;
        for (std::size_t i = 0; i < all.size(); ++i) {
            std::string fault;
            all[i] = registers::read_language(asset("schema/profiles/" + std::string(name_of(static_cast<ProfileLanguage>(i))) + ".json"),
                                              fault);
            EXPECT_TRUE(all[i]) << fault;
        }
        return all;
    }
    Mapping mapping(std::uint16_t address, const char* axis, const char* point, MapType type, MapAccess access,
                    MapWordOrder order = MapWordOrder::high_first) {
        Mapping m;
        m.id = std::to_string(maps.size());
        m.unit = 40;
        m.address = address;
        m.axis = axis;
        m.point = point;
        if (const auto p = axis_point_named(point)) {
            m.what = *p;
        } else {
            m.what = Point{static_cast<std::uint16_t>(m.point == "AC" ? 0 : 1), 0};
        }
        m.type = type;
        m.access = access;
        m.word_order = order;
        return m;
    }
    void add(std::uint16_t address, const char* axis, const char* point, MapType type, MapAccess access = MapAccess::read_write,
             MapWordOrder order = MapWordOrder::high_first) {
        maps.push_back(mapping(address, axis, point, type, access, order));
    }
    AssemblySpec spec(std::uint16_t instance, AssemblyDirection direction, std::uint16_t address, std::uint16_t registers) {
        AssemblySpec a;
        a.instance = instance;
        a.direction = direction;
        a.unit = 40;
        a.table = MapTable::holding_registers;
        a.address = address;
        a.registers = registers;
        return a;
    }
    /// Applies a site as the server does.
    void put_site() {
        state.site.mappings = std::make_shared<const std::vector<Mapping>>(maps);
        image.on_site(state);
        std::vector<LayoutAxis> axes{{1, one, "feeder", &*catalogue}, {2, two, "slide", &*catalogue}};
        values.use(Layout(std::move(axes), ++revision, {}, windows_of(state), objects_of(state, values.languages())));
        port.commands.clear();
    }
    Bytes read(std::uint32_t instance) {
        Bytes b;
        values.read(instance, port.now(), b);
        return b;
    }

    std::optional<Catalogue> catalogue;
    WindowPort port;
    registers::RegisterImage image{port, {.languages = languages()}};
    AxisValues values{port, image, 30};
    SiteState state;
    std::vector<Mapping> maps;
    std::uint32_t revision = 0;
    AxisId one{}, two{};
    struct Published {
        cip::Token token;
        General general;
        Bytes value;
    };
    std::vector<Published> published;
    cip::Peer plc{{0xC0000207, 50'000}, 1};
};

using enum AssemblyDirection;

}  // namespace axisgate::enip
