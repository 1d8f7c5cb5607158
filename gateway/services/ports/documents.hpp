// Document port: small named texts of services: recipes, reports of their runs, what is kept of alarms.
// In: texts by kind and name. Out: them again; callbacks on the service thread when a change is on disk.
// Never looks into a text.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace axisgate {

struct Document {
    std::string name, text, who;
    std::int64_t at_unix_ns = 0;
};

class DocumentPort {
public:
    virtual ~DocumentPort() = default;
    /// In order of name.
    [[nodiscard]] virtual std::vector<Document> documents(const std::string& kind) const = 0;
    [[nodiscard]] virtual std::optional<Document> document(const std::string& kind, const std::string& name) const = 0;
    /// Answers when it is on disk; empty: good, else what is wrong.
    virtual void save_document(const std::string& kind, Document document, std::function<void(std::string)> then) = 0;
    virtual void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) = 0;
};

}  // namespace axisgate
