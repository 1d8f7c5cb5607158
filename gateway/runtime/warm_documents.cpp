// Warm gateway, documents and events of doors: small named texts through the cold thread, events by the hot one's road.
// In: calls on the warm thread. Out: what is stored; callbacks on the warm executor when it is on disk.
// Never blocks but for a local read of the database.
#include <boost/asio/post.hpp>

#include "gateway/runtime/warm_gateway.hpp"

namespace axisgate {
namespace {
Gateway::Document shown(StoreDocument&& d) { return {std::move(d.name), std::move(d.text), std::move(d.who), d.at_unix_ns}; }
}  // namespace

void WarmGateway::note(Event event) {
    // Numbered and kept with all others: the hot thread hands events to the cold one.
    if (hot_.jobs().push([this, event = std::move(event)](Engine&, Instant now) mutable { hot_.on_event(std::move(event), now); }))
        hot_.jobs().announce();
}

std::vector<Gateway::Document> WarmGateway::documents(const std::string& kind) const {
    std::vector<Document> out;
    if (auto rows = reader_->documents(kind)) {
        for (auto& d : *rows)
            out.push_back(shown(std::move(d)));
    }
    return out;
}

std::optional<Gateway::Document> WarmGateway::document(const std::string& kind, const std::string& name) const {
    auto row = reader_->document(kind, name);
    if (!row || !*row) return std::nullopt;
    return shown(std::move(**row));
}

void WarmGateway::save_document(const std::string& kind, Document document, std::function<void(std::string)> then) {
    cold_.run([this, kind, d = std::move(document), then = std::move(then)](Store& store) mutable {
        const auto saved = store.save_document({kind, std::move(d.name), std::move(d.text), std::move(d.who), d.at_unix_ns});
        boost::asio::post(io_, [then = std::move(then), fault = saved ? std::string() : saved.error().text] { then(fault); });
    });
}

void WarmGateway::delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) {
    cold_.run([this, kind, name, then = std::move(then)](Store& store) mutable {
        const auto gone = store.delete_document(kind, name);
        boost::asio::post(io_, [then = std::move(then), fault = gone ? std::string() : gone.error().text] { then(fault); });
    });
}

}  // namespace axisgate
