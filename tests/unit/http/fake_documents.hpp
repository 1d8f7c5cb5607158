// The document, description and snapshot port for tests, with a disk that the test may delay (until catch_up()) or fill.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gateway/services/ports/descriptions.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/snapshots.hpp"

namespace axisgate::http::test {

class FakeDocuments : public DocumentPort {
public:
    std::vector<Document> documents(const std::string& kind) const override {
        std::vector<Document> out;
        for (const auto& [key, d] : stored_documents) {
            if (key.first == kind) out.push_back(d);
        }
        return out;
    }
    std::optional<Document> document(const std::string& kind, const std::string& name) const override {
        const auto it = stored_documents.find({kind, name});
        return it == stored_documents.end() ? std::nullopt : std::optional(it->second);
    }
    void save_document(const std::string& kind, Document d, std::function<void(std::string)> then) override {
        if (!document_fault.empty()) return then(document_fault);
        ++document_saves;
        on_disk([this, kind, d = std::move(d), then] {
            stored_documents[{kind, d.name}] = d;
            then("");
        });
    }
    void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) override {
        on_disk([this, kind, name, then] { then(stored_documents.erase({kind, name}) == 0 ? "there is none of this name" : ""); });
    }
    /// Changes of documents wait in their order until catch_up().
    bool disk_is_behind = false;
    std::deque<std::function<void()>> disk;
    std::size_t document_saves = 0;
    void on_disk(std::function<void()> job) {
        disk.push_back(std::move(job));
        if (!disk_is_behind) catch_up();
    }
    void catch_up() {
        disk_is_behind = false;
        while (!disk.empty()) {
            const auto job = std::move(disk.front());
            disk.pop_front();
            job();
        }
    }
    std::map<std::pair<std::string, std::string>, Document> stored_documents;
    std::string document_fault;
};

class FakeDescriptions : public DescriptionPort {
public:
    DescriptionShelf shelf;
    std::string description_fault;
    const DescriptionShelf& descriptions() const override { return shelf; }
    void add_description(Description d, std::function<void(std::string)> then) override {
        if (description_fault.empty()) shelf.put(std::move(d));
        then(description_fault);
    }
    void remove_description(const std::string& name, std::function<void(std::string)> then) override {
        if (description_fault.empty()) shelf.remove(name);
        then(description_fault);
    }
};

class FakeSnapshots : public SnapshotPort {
public:
    std::map<std::string, std::vector<AxisSnapshot>> kept_snapshots;
    std::string keep_fault;

    std::vector<SnapshotInfo> snapshots(const std::string& name) const override {
        const auto it = kept_snapshots.find(name);
        return it == kept_snapshots.end() ? std::vector<SnapshotInfo>{} : std::vector<SnapshotInfo>(it->second.begin(), it->second.end());
    }
    std::optional<AxisSnapshot> snapshot(const std::string& name, std::uint32_t n) const override {
        if (const auto it = kept_snapshots.find(name); it != kept_snapshots.end()) {
            for (const auto& s : it->second) {
                if (s.n == n) return s;
            }
        }
        return std::nullopt;
    }
    bool axis_gone = false;  ///< the store has removed the axis already, and this thread has not
    void save_snapshot(AxisSnapshot s, std::string name, std::function<void(std::uint32_t, std::string, bool)> then) override {
        if (axis_gone) return then(0, "the axis was removed meanwhile", true);
        if (!keep_fault.empty()) return then(0, keep_fault, false);
        s.n = static_cast<std::uint32_t>(kept_snapshots[name].size() + 1);
        kept_snapshots[name].push_back(s);
        then(s.n, "", false);
    }
    void delete_snapshot(std::string name, std::uint32_t n, std::function<void(std::string)> then) override {
        std::erase_if(kept_snapshots[name], [n](const auto& s) { return s.n == n; });
        then("");
    }
};

}  // namespace axisgate::http::test
