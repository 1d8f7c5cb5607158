// The stage, register, Modbus and backup port for tests; each answers inside the call as the test has set.
#pragma once

#include <optional>
#include <string>
#include <tuple>

#include "gateway/services/axis_place.hpp"
#include "gateway/services/ports/backup.hpp"
#include "gateway/services/ports/modbus.hpp"
#include "gateway/services/ports/registers.hpp"
#include "gateway/services/ports/stage.hpp"
#include "tests/unit/http/fake_clock.hpp"
#include "tests/unit/http/fake_site.hpp"

namespace axisgate::http::test {

class FakeStage : public StagePort {
public:
    FakeStage(FakeSite& sites, const FakeClock& clock) : sites_(sites), clock_(clock) {}
    SiteStage stage;
    const SiteStage& site_stage() const override { return stage; }
    std::string stage_site(Site s, std::uint64_t base, const Origin& o) override {
        return stage.stage(std::move(s), base, o.who ? *o.who : "");
    }
    std::string discard_stage() override { return stage.discard(); }
    void apply_stage(std::uint32_t within, Origin o, std::function<void(SiteAnswer)> then) override {
        if (auto fault = stage.begin_apply(sites_.site()->revision, within, clock_.now_ns, *o.who); !fault.empty())
            return then({false, fault, sites_.site()});
        before_trial = sites_.site()->site;
        sites_.put_site(Site(stage.site()));
        stage.applied(true);
        then({true, "", sites_.site()});
    }
    std::string confirmed_by;
    void confirm_stage(Origin o, std::function<void(std::string)> then) override {
        if (auto fault = stage.check_confirm(*o.who, clock_.now_ns); !fault.empty()) return then(fault);
        confirmed_by = *o.who;
        stage.confirmed();
        then("");
    }
    void roll_back_stage(Origin, std::function<void(SiteAnswer)> then) override {
        if (auto fault = stage.begin_roll_back(); !fault.empty()) return then({false, fault, sites_.site()});
        sites_.put_site(Site(before_trial));
        stage.rolled_back(true, 0);
        then({true, "", sites_.site()});
    }
    Site before_trial;

private:
    FakeSite& sites_;
    const FakeClock& clock_;
};

class FakeRegisters : public RegisterPort {
public:
    std::optional<registers::RegisterRead> registers_answer;
    std::tuple<std::uint8_t, registers::Table, std::uint16_t, std::uint16_t> registers_asked;
    void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                        std::function<void(std::optional<registers::RegisterRead>)> then) override {
        registers_asked = {unit, table, address, count};
        then(registers_answer);
    }
};

class FakeModbus : public ModbusPort {
public:
    explicit FakeModbus(const std::string& keep_fault) : fault_(keep_fault) {}
    std::optional<ModbusReport> modbus_door;
    void modbus_report(std::function<void(std::optional<ModbusReport>)> then) override { then(modbus_door); }
    void set_modbus_read_only(bool on, Origin, std::function<void(std::string, bool)> then) override {
        if (!modbus_door) return then("there is no Modbus door", false);
        if (!fault_.empty()) return then(fault_, true);
        modbus_door->read_only = on;
        then("", false);
    }

private:
    const std::string& fault_;
};

class FakeConnections : public ConnectionPort {
public:
    std::vector<ClientConnection> open{{"enip-65537", "enip", "exclusive_owner", "192.0.2.7:50000", 1, 2, {"feeder"}, true}};
    void list_connections(std::function<void(List)> then) override { then(open); }
    void closed_by(Site wanted, std::function<void(List)> then) override {
        auto list = open;
        std::erase_if(list, [&](const auto& c) {
            return std::ranges::all_of(c.axes, [&](const auto& name) { return index_of_name(wanted.axes, name).has_value(); });
        });
        then(std::move(list));
    }
    void close_connection(std::string id, Origin, std::function<void(Closed)> then) override {
        then(std::erase_if(open, [&](const auto& c) { return c.id == id; }) > 0 ? Closed::done : Closed::unknown);
    }
};

class FakeBackup : public BackupPort {
public:
    explicit FakeBackup(const std::string& keep_fault) : fault_(keep_fault) {}
    std::string bytes = "SQLite", restored;
    std::string passphrase;  ///< the last one that was sent
    void backup(std::string with, std::function<void(std::optional<std::string>, BackupOutcome)> then) override {
        passphrase = std::move(with);
        if (passphrase == "unfit") return then(std::nullopt, {"a passphrase has 12 to 256 characters", false, {}});
        then(bytes, {});
    }
    void restore(std::string sent, std::string with, Origin, std::function<void(BackupOutcome)> then) override {
        restored = std::move(sent);
        passphrase = std::move(with);
        then({fault_, no_room, {}});
    }
    std::optional<WaitingBackup> waits;
    bool no_room = false;
    void waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) override { then(waits); }
    void cancel_restore(Origin, std::function<void(std::string)> then) override {
        then(waits ? "" : "none");
        waits.reset();
    }

private:
    const std::string& fault_;
};

}  // namespace axisgate::http::test
