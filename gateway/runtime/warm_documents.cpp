// Warm gateway, scans, documents and events of doors: questions to the hot thread, small named texts and events to the cold one.
// In: calls on the warm thread. Out: what is stored; callbacks on the warm executor when it is on disk.
// Never blocks but for a local read of the database.
#include <fmt/core.h>

#include <boost/asio/post.hpp>

#include "gateway/runtime/warm_gateway.hpp"

namespace axisgate {
namespace {
constexpr const char* too_much = "too much is asked at once; come again in a moment";
/// A report that could not be had now.
ScanReport no_report() {
    ScanReport r;
    r.state = ScanReport::State::failed;
    r.text = too_much;
    return r;
}
Gateway::Document shown(StoreDocument&& d) { return {std::move(d.name), std::move(d.text), std::move(d.who), d.at_unix_ns}; }
}  // namespace

void WarmGateway::note(Event event) {
    events_.tell(std::move(event), monotonic_now());
    cold_.from_service().announce();
}

void WarmGateway::start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) {
    auto job = [this, line, wish = std::move(wish), origin = std::move(origin), then](Engine& engine, Instant now) mutable {
        std::string fault = engine.start_scan(line, std::move(wish), now);
        if (fault.empty()) {
            Event e;
            e.kind = "scan";
            for (std::size_t i = 0; i < engine.site()->line_ids.size(); ++i) {
                if (engine.site()->line_ids[i] == line) e.line = engine.site()->site.lines[i].name;
            }
            e.text = fmt::format("line {} is searched for drives", e.line);
            e.who = origin.who ? *origin.who : "";
            e.door = std::string(name_of(origin.door));
            hot_.on_event(std::move(e), now);
        }
        boost::asio::post(io_, [then, fault = std::move(fault)]() mutable { then(std::move(fault)); });
    };
    if (!hot_.jobs().push(std::move(job))) {
        boost::asio::post(io_, [then] { then(too_much); });
        return;
    }
    hot_.jobs().announce();
}

void WarmGateway::scan_report(LineId line, std::function<void(ScanReport)> then) {
    auto job = [this, line, then](Engine& engine, Instant) { boost::asio::post(io_, [then, r = engine.scan_report(line)]() mutable { then(std::move(r)); }); };
    if (!hot_.jobs().push(std::move(job))) return boost::asio::post(io_, [then] { then(no_report()); });
    hot_.jobs().announce();
}

void WarmGateway::cancel_scan(LineId line, std::function<void(ScanReport)> then) {
    auto job = [this, line, then](Engine& engine, Instant now) {
        engine.cancel_scan(line, now);
        boost::asio::post(io_, [then, r = engine.scan_report(line)]() mutable { then(std::move(r)); });
    };
    if (!hot_.jobs().push(std::move(job))) return boost::asio::post(io_, [then] { then(no_report()); });
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
