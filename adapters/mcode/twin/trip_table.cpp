// TripTable: defining, enabling and meeting trips.
// In: statements with worked-out fields. Out: MCode error codes, targets.
// Never enables what is not defined.
#include "adapters/mcode/twin/trip_table.hpp"

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {

int TripTable::define(const Statement& s, std::span<const Number> fields, Instant now) {
    const bool none = s.target && s.target->label == no_symbol && s.target->address == 0 && !s.target->missing_name;
    if (!(none && s.word == Word::TR)) {
        int error = 0;
        if (!s.target || program_.find(*s.target, error) < 0) return err::unknown_name;
    }
    Trip t;
    t.defined = true;
    t.target = *s.target;
    if (s.word == Word::TT) {
        t.ms = fields[0].as_integer();
        if (t.ms < 1 || t.ms > 65535) return err::bad_value;
    } else {
        if (s.word == Word::TR && fields.size() > 1) {
            t.repeats = fields[1].as_integer();
            if (t.repeats < 0 || t.repeats > 65000) return err::bad_value;
            t.left = t.repeats;
        }
        if (const int code = motor_.arm(s.word, fields, now); code != 0) return code;
    }
    trips_[trip_index(s.word)] = t;
    return 0;
}

int TripTable::enable(std::int64_t mask, Instant now) {
    for (std::size_t i = 0; i < trips_.size(); ++i) {
        if ((mask >> i & 1) != 0 && !trips_[i].defined) return err::trip_undefined;
    }
    const int before = te_, after = static_cast<int>(mask);
    const auto begins = [&](Word w) { return ((after & ~before) >> trip_index(w) & 1) != 0; };
    if ((after & 2) != 0 && (after & 16) != 0) return err::two_trips;
    te_ = after;
    if (begins(Word::TT)) time_ = now + std::chrono::milliseconds(trips_[trip_index(Word::TT)].ms);
    if (!on(Word::TT)) time_ = never;
    Trip& distance = trips_[trip_index(Word::TR)];
    if (begins(Word::TR)) distance.left = distance.repeats;  // each series begins with TE [L5836]
    motor_.enable_trips(te_, now);
    return 0;
}

const Target* TripTable::met(Word word, Instant now) {
    const std::size_t i = trip_index(word);
    if (i >= trips_.size() || !on(word)) return nullptr;
    Trip& t = trips_[i];
    if (word != Word::TR || (t.repeats > 0 && --t.left <= 0)) {
        te_ &= ~(1 << i);
        motor_.enable_trips(te_, now);
    }
    return &t.target;
}

void TripTable::clear() noexcept {
    trips_ = {};
    te_ = 0;
    time_ = never;
}

}  // namespace axisgate::mcode::twin
