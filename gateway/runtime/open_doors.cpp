// Doors are opened in the order of the list.
#include "gateway/runtime/open_doors.hpp"

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/runtime/warm_ports.hpp"

namespace axisgate {

/// In reverse order, since a door may use an earlier one.
OpenDoors::~OpenDoors() {
    while (!doors_.empty())
        doors_.pop_back();
}

int OpenDoors::open(const DoorHouse& house, std::span<const DoorDescriptor* const> doors) {
    for (const DoorDescriptor* descriptor : doors) {
        if (!descriptor->wanted(house.config)) continue;
        std::vector<ConfigFault> faults;
        auto door = descriptor->make(house, faults);
        for (const auto& f : faults)
            complain(fmt::format("{}: {}; {}", f.place, f.text, f.remedy));
        if (!door) return exit_usage;
        doors_.push_back(std::move(door));
    }
    std::vector<const RunningDoor*> left_out;
    for (auto& door : doors_) {
        if (!open_or_wait(*door, left_out)) return exit_failed;
    }
    std::erase_if(doors_, [&](const auto& door) { return std::ranges::find(left_out, door.get()) != left_out.end(); });
    on_hot_ = addresses_on_hot();
    tell();
    ports_.status.doors_waiting = [this] { return waiting(); };
    ports_.status.door_metrics = [this] { return metrics(); };
    return exit_good;
}

/// Waits if the address does not exist yet. Returns false if the door cannot be opened, which has been reported.
bool OpenDoors::open_or_wait(RunningDoor& door, std::vector<const RunningDoor*>& left_out) {
    std::string fault = door.open();
    if (fault.empty()) {
        door.opened();
        return true;
    }
    if (const std::string without = door.left_out(); !without.empty()) {
        spdlog::warn("{}; {}", fault, without);
        left_out.push_back(&door);
        return true;
    }
    if (!door.is_late()) {
        complain(fault);
        return false;
    }
    LateDoors::Door late{door.name(), std::move(fault), [&door] { return door.is_late(); }, {}, {}};
    late.open = [this, &door](std::function<void(std::string)> then) { open_late(door, std::move(then)); };
    late.opened = [this, &door] {
        door.opened();
        tell();
    };
    late_.wait_for(std::move(late));
    return true;
}

/// Called when threads run: a door of the hot thread is opened there.
void OpenDoors::open_late(RunningDoor& door, std::function<void(std::string)> then) {
    if (!door.on_hot()) return then(door.open());
    const bool given = hot_.jobs().push([this, &door, then](Engine& engine, Instant) {
        std::string why = door.open();
        if (why.empty()) hot_.publish_site(*engine.site());  // a door may show its own address
        boost::asio::post(service_, [this, then, why = std::move(why), now = addresses_on_hot()]() mutable {
            on_hot_ = std::move(now);
            then(std::move(why));
        });
    });
    if (!given) return then("the hot thread has too much to do");
    hot_.jobs().announce();
}

std::vector<DoorInfo> OpenDoors::addresses_on_hot() const {
    std::vector<DoorInfo> now;
    for (const HotDoor* door : hot_.doors()) {
        for (auto& address : door->addresses())
            now.push_back({std::string(door->name()), std::move(address)});
    }
    return now;
}

void OpenDoors::tell() const {
    std::vector<DoorInfo> open = on_hot_;
    for (const auto& door : doors_) {
        if (std::string address = door->address(); !address.empty()) open.push_back({door->name(), std::move(address)});
    }
    ports_.status.set_doors(std::move(open));
}

std::string OpenDoors::metrics() const {
    std::string text;
    for (const HotDoor* door : hot_.doors())
        text += door->metrics();
    for (const auto& door : doors_)
        text += door->metrics();
    return text;
}

std::string OpenDoors::page() const {
    for (const auto& door : doors_) {
        if (std::string page = door->page(); !page.empty()) return page;
    }
    return {};
}

void OpenDoors::on_change() {
    for (const auto& door : doors_)
        door->on_change();
}

void OpenDoors::take_mirror(int fd) {
    for (const auto& door : doors_) {
        if (door->take_mirror(fd)) return;
    }
    ::close(fd);
}

void OpenDoors::stop() {
    const auto open = std::make_shared<std::size_t>(doors_.size());
    for (const auto& door : doors_)
        door->stop([open] { --*open; });
    const Instant limit = monotonic_now() + std::chrono::seconds(3);
    while (*open > 0 && monotonic_now() < limit)
        (void)service_.run_one_for(std::chrono::milliseconds(50));
}

bool OpenDoors::hang() const {
    return std::ranges::any_of(doors_, [](const auto& door) { return door->hangs(); });
}

}  // namespace axisgate
