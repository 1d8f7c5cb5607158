// Part: one thing of a drive, with a state of its own, that reaches the other parts by its drive.
// In: the drive that it belongs to, whose member it is. Out: nothing. Never outlives its drive, and is never copied: the others know its
// place.
#pragma once

namespace axisgate::drive {

/// `Drive` is the family's, and may be declared alone where its parts are.
template <class Drive>
class Part {
public:
    explicit Part(Drive& drive) noexcept : drive_(drive) {}
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

protected:
    ~Part() = default;
    Drive& drive_;
};

}  // namespace axisgate::drive
