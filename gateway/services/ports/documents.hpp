// Small named texts of services: recipes, reports of their runs, alarms. Callbacks come on the service thread when a change is on the disk.
// The texts are not interpreted here.
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
    /// Answers when the document is on the disk; empty if good, otherwise the fault.
    virtual void save_document(const std::string& kind, Document document, std::function<void(std::string)> then) = 0;
    virtual void delete_document(const std::string& kind, const std::string& name, std::function<void(std::string)> then) = 0;
};

}  // namespace axisgate
