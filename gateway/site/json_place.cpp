// JSON place: finds the line of a JSON pointer's value in a text, so that a fault can name it.
// The text need not be well formed. If the value does not exist, the line of the nearest existing place is returned.
#include <cctype>

#include "gateway/site/site.hpp"

namespace axisgate {
namespace {
/// Walks through JSON text and follows its structure only, without checking it.
class Walker {
public:
    explicit Walker(std::string_view text) : s_(text) {}

    std::size_t find(std::string_view pointer) {
        skip_space();
        std::size_t best = i_;
        while (!pointer.empty()) {
            pointer.remove_prefix(1);
            const auto slash = pointer.find('/');
            const std::string token(pointer.substr(0, slash));
            pointer = slash == std::string_view::npos ? std::string_view{} : pointer.substr(slash);
            if (!enter(token)) break;
            best = i_;
        }
        return line(best);
    }

private:
    [[nodiscard]] std::size_t line(std::size_t at) const {
        std::size_t n = 1;
        for (std::size_t k = 0; k < at && k < s_.size(); ++k)
            n += s_[k] == '\n';
        return n;
    }
    void skip_space() {
        while (i_ < s_.size() && std::isspace(static_cast<unsigned char>(s_[i_])))
            ++i_;
    }
    std::string string() {
        std::string out;
        if (i_ < s_.size() && s_[i_] == '"') ++i_;
        while (i_ < s_.size() && s_[i_] != '"') {
            if (s_[i_] == '\\' && i_ + 1 < s_.size()) ++i_;
            out += s_[i_++];
        }
        if (i_ < s_.size()) ++i_;
        return out;
    }
    void skip_value() {
        skip_space();
        if (i_ >= s_.size()) return;
        if (s_[i_] == '"') {
            (void)string();
            return;
        }
        int depth = 0;
        while (i_ < s_.size()) {
            const char c = s_[i_];
            if (c == '"') {
                (void)string();
                continue;
            }
            if (c == '{' || c == '[') ++depth;
            if (c == '}' || c == ']') {
                if (depth == 0) return;
                if (--depth == 0) {
                    ++i_;
                    return;
                }
            }
            if (depth == 0 && c == ',') return;
            ++i_;
        }
    }
    bool enter(const std::string& token) {
        skip_space();
        if (i_ >= s_.size()) return false;
        const char open = s_[i_];
        if (open != '{' && open != '[') return false;
        ++i_;
        for (std::size_t n = 0; i_ < s_.size(); ++n) {
            skip_space();
            if (i_ >= s_.size() || s_[i_] == '}' || s_[i_] == ']') return false;
            std::size_t place = i_;
            std::string key = std::to_string(n);
            if (open == '{') {
                key = string();
                skip_space();
                if (i_ < s_.size() && s_[i_] == ':') ++i_;
                skip_space();
            }
            if (key == token) {
                // The line of a member is the line of its key, where a reader looks for it.
                if (open == '{' && i_ < s_.size() && s_[i_] != '{' && s_[i_] != '[') i_ = place;
                return true;
            }
            skip_value();
            skip_space();
            if (i_ < s_.size() && s_[i_] == ',') ++i_;
        }
        return false;
    }

    std::string_view s_;
    std::size_t i_ = 0;
};
}  // namespace

std::size_t line_of_pointer(std::string_view text, std::string_view pointer) { return Walker(text).find(pointer); }

}  // namespace axisgate
