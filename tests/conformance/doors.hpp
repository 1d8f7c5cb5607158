// The doors of a world between its engine and their clients: the registers with their writer, and the EtherNet/IP objects. A test writes
// through them as a PLC does; results are delivered between two steps.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/registers/register_image.hpp"
#include "gateway/registers/writer.hpp"
#include "tests/world/world.hpp"

namespace axisgate::test {

/// The doors' side of a world: commands of its doors go to the engine, results are delivered between two steps.
struct WorldDoors final : DoorPort {
    explicit WorldDoors(World& of) : world(of) {}
    World& world;
    std::vector<HotDoor*> doors;
    std::vector<Ticket> given;

    Instant now() const override { return world.now; }
    const Image& image() const override { return world.image; }
    const Catalogue* catalogue(AxisId axis) const override { return world.engine.catalogue(axis); }
    void submit(Command command) override {
        given.push_back(command.ticket);
        world.engine.on_command(std::move(command), world.now);
    }
    std::optional<Refusal> set_point(const SetPoint& point) override { return world.engine.on_set_point(point, world.now); }
    void client_lost(const AuthorityClient& who, LossCause cause) override { world.engine.on_client_lost(who, cause, world.now); }
    DoorNumber attach(HotDoor& door) override {
        doors.push_back(&door);
        return static_cast<DoorNumber>(doors.size());
    }
    void detach(HotDoor& door) override { std::ranges::replace(doors, &door, nullptr); }
    /// A door that gets a result may give its next command at once.
    void deliver() {
        for (std::size_t i = 0; i < given.size();) {
            const Result* r = world.result(given[i]);
            if (!r) {
                ++i;
                continue;
            }
            const Ticket t = given[i];
            given.erase(given.begin() + static_cast<std::ptrdiff_t>(i));
            if (HotDoor* door = doors.at(door_of(t) - 1u)) door->on_result(*r);
        }
    }
};

/// Registers as Modbus clients write them.
struct WriterDoor final : HotDoor {
    WriterDoor(DoorPort& port, registers::RegisterImage& image)
        : writer(port, image, {modbus::clients, std::chrono::seconds(30), 4096, words}) {
        writer.use_number(port.attach(*this));
    }
    static std::string words(registers::Verdict v) { return "exception " + std::to_string(static_cast<int>(v)); }
    std::span<const WayIn> ways_in() const override { return modbus::tcp_ways; }
    std::string_view name() const override { return "modbus"; }
    void on_result(const Result& r) override { writer.on_result(r); }
    registers::RegisterWriter writer;
};

/// Assemblies, classes and attributes as scanners and messages write them.
struct EnipDoor final : HotDoor {
    EnipDoor(DoorPort& port, registers::RegisterImage& image) : values(port, image, 30) {
        values.use_number(port.attach(*this));
        values.use([this](cip::Token, cip::General g, cip::View, std::uint16_t) { published = g; });
    }
    std::span<const WayIn> ways_in() const override { return enip::ways_of_clients; }
    std::string_view name() const override { return "enip"; }
    void on_result(const Result& r) override { values.on_result(r); }
    enip::AxisValues values;
    std::optional<cip::General> published;
};

/// The register languages that the program contains.
inline registers::Languages languages() {
    registers::Languages all;
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::string fault;
        all[i] =
            registers::read_language(asset("schema/profiles/" + std::string(name_of(static_cast<ProfileLanguage>(i))) + ".json"), fault);
        EXPECT_TRUE(all[i]) << fault;
    }
    return all;
}

}  // namespace axisgate::test
