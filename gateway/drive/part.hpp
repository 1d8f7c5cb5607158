// Part is the base of a member of a drive that has a state of its own and reaches the other parts through the drive. It is never copied,
// because the other parts hold its address.
#pragma once

namespace axisgate::drive {

/// `Drive` is a type of the family; a forward declaration is sufficient.
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
