// Ports of a gateway by itself that keep nothing: reports of a run are not stored, and events have no readers.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/services/ports/documents.hpp"
#include "gateway/services/ports/events.hpp"

namespace axisgate {

class NoDocuments : public DocumentPort {
public:
    [[nodiscard]] std::vector<Document> documents(const std::string&) const override { return {}; }
    [[nodiscard]] std::optional<Document> document(const std::string&, const std::string&) const override { return {}; }
    void save_document(const std::string&, Document, std::function<void(std::string)> then) override { then(""); }
    void delete_document(const std::string&, const std::string&, std::function<void(std::string)> then) override { then(""); }
};

class NoEvents : public EventPort {
public:
    [[nodiscard]] std::vector<Event> events(const EventQuery&) const override { return {}; }
    void note(Event) override {}
    void listen(EventListener*) override {}
    void unlisten(EventListener*) override {}
};

}  // namespace axisgate
