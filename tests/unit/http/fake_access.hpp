// An AccessPort for tests: it hashes at once ("hash of PASSWORD"), keeps records in memory, or fails on request, without thread and clock.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "gateway/services/access/access_port.hpp"

namespace axisgate::http::test {

class FakeAccess final : public AccessPort {
public:
    explicit FakeAccess(AccessSettings settings = {}) : own_accounts(settings) {}
    AccessRegister& accounts() override { return own_accounts; }
    bool derive(std::string password, std::function<void(std::string)> then) override {
        if (full) return false;
        then("hash of " + password);
        return true;
    }
    bool compare(std::string password, std::string hash, std::function<void(bool)> then) override {
        if (full) return false;
        ++compared;
        then(hash == "hash of " + password);
        return true;
    }
    void keep(std::vector<AccessRecord> records, std::string, std::function<void(std::string)> then) override {
        auto write = [this, records = std::move(records), then = std::move(then)] {
            if (store_fault.empty()) kept.insert(kept.end(), records.begin(), records.end());
            then(store_fault);
        };
        if (slow_disk) return writing.push_back(std::move(write));
        write();
    }
    /// The disk has carried out its oldest job.
    void write_one() {
        const auto write = std::move(writing.front());
        writing.pop_front();
        write();
    }
    void note(Event event) override { published.push_back(std::move(event)); }

    AccessRegister own_accounts;
    bool full = false;
    bool slow_disk = false;
    std::deque<std::function<void()>> writing;
    int compared = 0;
    std::string store_fault;
    std::vector<AccessRecord> kept;
    std::vector<Event> published;
};

}  // namespace axisgate::http::test
