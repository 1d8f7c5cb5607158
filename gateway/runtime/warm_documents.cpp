// Reads come from this thread's own reader of the database, changes go to the storage thread.
#include "gateway/runtime/warm_documents.hpp"

namespace axisgate {
namespace {
Document shown(StoreDocument&& d) { return {std::move(d.name), std::move(d.text), std::move(d.who), d.at_unix_ns}; }
}  // namespace

std::vector<Document> WarmDocuments::documents(const std::string& kind) const {
    std::vector<Document> out;
    if (auto rows = threads_.reader.documents(kind)) {
        for (auto& d : *rows)
            out.push_back(shown(std::move(d)));
    }
    return out;
}

std::optional<Document> WarmDocuments::document(const std::string& kind, const std::string& name) const {
    auto row = threads_.reader.document(kind, name);
    if (!row || !*row) return std::nullopt;
    return shown(std::move(**row));
}

void WarmDocuments::save_document(const std::string& kind, Document document, std::function<void(std::string)> then) {
    threads_.on_cold([this, kind, d = std::move(document), then = std::move(then)](Store& store) mutable {
        const auto saved = store.save_document({kind, std::move(d.name), std::move(d.text), std::move(d.who), d.at_unix_ns});
        threads_.answer([then = std::move(then), fault = saved ? std::string() : saved.error().text] { then(fault); });
    });
}

void WarmDocuments::delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) {
    threads_.on_cold([this, kind, name, then = std::move(then)](Store& store) mutable {
        const auto gone = store.delete_document(kind, name);
        threads_.answer([then = std::move(then), fault = gone ? std::string() : gone.error().text] { then(fault); });
    });
}

std::vector<SnapshotInfo> WarmSnapshots::snapshots(const std::string& axis) const {
    return threads_.reader.snapshots(axis).value_or(std::vector<SnapshotInfo>());
}

std::optional<AxisSnapshot> WarmSnapshots::snapshot(const std::string& axis, std::uint32_t n) const {
    return threads_.reader.snapshot(axis, n).value_or(std::nullopt);
}

void WarmSnapshots::save_snapshot(AxisSnapshot snapshot, std::string axis,
                                  std::function<void(std::uint32_t n, std::string fault, bool axis_gone)> then) {
    threads_.on_cold([this, s = std::move(snapshot), axis = std::move(axis), then = std::move(then)](Store& store) {
        const auto n = store.save_snapshot(axis, s.name, s.comment, s.who, s.at_unix_ns, s.parameters);
        const bool gone = !n && n.error().kind == StoreError::Kind::not_found;
        threads_.answer([then, n = n ? *n : 0, fault = n ? std::string() : n.error().text, gone] { then(n, fault, gone); });
    });
}

void WarmSnapshots::delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) {
    threads_.on_cold([this, axis = std::move(axis), n, then = std::move(then)](Store& store) {
        const auto done = store.delete_snapshot(axis, n);
        threads_.answer([then, fault = done ? std::string() : done.error().text] { then(fault); });
    });
}

}  // namespace axisgate
