// The document and the snapshot port: small named texts and numbered sets of values in the database. The storage thread writes them and
// calls back when they are on the disk.
#pragma once

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/snapshots.hpp"

namespace axisgate {

class WarmDocuments final : public DocumentPort {
public:
    explicit WarmDocuments(const WarmThreads& threads) : threads_(threads) {}
    [[nodiscard]] std::vector<Document> documents(const std::string& kind) const override;
    [[nodiscard]] std::optional<Document> document(const std::string& kind, const std::string& name) const override;
    void save_document(const std::string& kind, Document document, std::function<void(std::string)> then) override;
    void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) override;

private:
    const WarmThreads& threads_;
};

class WarmSnapshots final : public SnapshotPort {
public:
    explicit WarmSnapshots(const WarmThreads& threads) : threads_(threads) {}
    [[nodiscard]] std::vector<SnapshotInfo> snapshots(const std::string& axis) const override;
    [[nodiscard]] std::optional<AxisSnapshot> snapshot(const std::string& axis, std::uint32_t n) const override;
    void save_snapshot(AxisSnapshot snapshot, std::string axis,
                       std::function<void(std::uint32_t n, std::string fault, bool axis_gone)> then) override;
    void delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) override;

private:
    const WarmThreads& threads_;
};

}  // namespace axisgate
