// Device: PR and the printed form of words.
// In: items of a PR. Out: text.
// Never writes a word; only reading ER clears it.
#include <algorithm>

#include "adapters/mcode/twin/device.hpp"
#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

std::optional<std::string> Device::text_of_word(Word word, int& error) {
    if (const int code = setup_.available(word); code != 0) {
        error = code;
        return std::nullopt;
    }
    switch (word) {
        case Word::DN:
            return std::string(1, comm_.flags.dn);
        case Word::PN:
            return setup_.part_number;
        case Word::SN:
            return setup_.serial_number;
        case Word::VR:
            return setup_.version_text();
        case Word::PF:
            return std::to_string(format_.width) + ',' + std::to_string(format_.decimals) + ',' + (format_.scientific ? '1' : '0') + ',' +
                   (format_.left ? '1' : '0');
        case Word::PW:
            return std::to_string(pw_[0]) + ',' + std::to_string(pw_[1]) + ',' + std::to_string(pw_[2]) + ',' + std::to_string(pw_[3]);
        case Word::UV: {
            if (!setup_.manners.lists) {
                error = err::bad_print;
                return std::nullopt;
            }
            std::string text;
            const Symbols& names = program_.symbols();
            for (std::size_t i = 0; i < names.size(); ++i) {
                const Symbol& v = names.at(static_cast<SymbolId>(i));
                if (v.kind != Symbol::Kind::global && v.kind != Symbol::Kind::local) continue;
                text +=
                    (text.empty() ? "" : "\r\n") + v.name + (v.kind == Symbol::Kind::global ? " = G " : " = L ") + std::to_string(v.value);
            }
            return text;
        }
        case Word::AL:
            if (setup_.manners.lists) return all_values();
            error = err::bad_print;
            return std::nullopt;
        default:
            break;
    }
    return info(word).owner == Owner::motor ? motor_->text(word, now_) : std::nullopt;
}

/// Product, then M for the serial link or E for Ethernet, as in the part number; firmware and hardware [L6192].
std::string DeviceSetup::version_text() const {
    const int version = manners.version;
    const std::string number = std::to_string(version / 1000) + '.' + std::to_string(1000 + version % 1000).substr(1);
    if (manners.version_alone) return number;
    return std::string((product & lmm) != 0    ? "LMMC"
                       : (product & lmdo) != 0 ? "LMDO"
                                               : "LMDC") +
           (ethernet ? "E " : "M ") + number + ", Hw: 3.2";
}

std::string Device::all_values() {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Word w = static_cast<Word>(i);
        const WordInfo& row = info(w);
        const bool shown = row.kind == WordKind::variable || row.kind == WordKind::flag || row.kind == WordKind::setup;
        if (!shown || row.access == Access::wo || setup_.available(w) != 0) continue;
        int error = 0;
        std::optional<std::string> value = text_of_word(w, error);
        const bool own_names = w == Word::IS || w == Word::OS || w == Word::LS;  // these print their name in each row
        if (!value && error == 0) value = to_text(read(w, error), format_);
        if (error != 0 || !value) continue;
        if (!text.empty()) text += "\r\n";
        text += own_names ? *value : std::string(row.text) + " = " + *value;
    }
    return text;
}

int Device::print(const Statement& s) {
    std::string text;
    bool read_error = false;
    for (std::size_t i = 0; i < s.items.size(); ++i) {
        const PrintItem& item = s.items[i];
        if (item.kind == PrintItem::Kind::text) {
            text += item.text;
            continue;
        }
        int error = 0;
        const Term& t = item.value.terms[0];
        const bool plain = item.value.terms.size() == 1 && t.prefix.empty() && !t.function;
        if (plain && t.operand.kind == Operand::Kind::word) {
            auto own = text_of_word(t.operand.word, error);
            if (error != 0) return error;
            // IT,1 and VT,2 ask for one field [L3615, L6203].
            const bool indexed = (t.operand.word == Word::IT || t.operand.word == Word::VT) && i + 1 < s.items.size() &&
                                 s.items[i + 1].kind == PrintItem::Kind::value && s.items[i + 1].value.terms.size() == 1 &&
                                 s.items[i + 1].value.terms[0].operand.kind == Operand::Kind::constant;
            if (own && indexed) {
                const std::int64_t n = s.items[++i].value.terms[0].operand.number.as_integer();
                if (n != 1 && n != 2) return err::bad_value;
                // IT: bridge, controller. VT: status, auxiliary, +V; the module has no auxiliary supply and answers with +V for both
                // [L6220-6228].
                const std::int64_t skip = t.operand.word == Word::IT ? n - 1 : (setup_.product & lmm) != 0 ? 1 : n;
                std::string_view rest = *own;
                for (std::int64_t k = 0; k < skip; ++k)
                    rest = trimmed(rest.substr(std::min(rest.find(','), rest.size() - 1) + 1));
                text += rest.substr(0, rest.find(','));
                continue;
            }
            if (own) {
                text += *own;
                continue;
            }
            if (t.operand.word == Word::IN) {
                const std::int64_t n = read(Word::IN, error).as_integer();
                if (n < 10) text += '0';  // two digits [E-61]
                text += std::to_string(n);
                continue;
            }
            read_error = read_error || t.operand.word == Word::ER;
        }
        const Number n = run_.value(item.value, false, error);  // only F registers calculate with fractions [L580]
        if (error != 0) return error;
        text += to_text(n, format_);
    }
    const bool program_output = data_ == nullptr;
    if (program_output) {
        say(text + (s.open_end ? "" : "\r\n"));
    } else {
        say(text);
        data_given_ = true;
        data_ended_ = !s.open_end;
    }
    if (read_error) error_ = {};
    return 0;
}

}  // namespace axisgate::mcode::twin
