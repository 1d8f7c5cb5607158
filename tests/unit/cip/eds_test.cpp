// Sheets of three hundred descriptions with any content, read back; names that would break a sheet; numbers without a form.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/fuzz/eds_laws.hpp"

namespace axisgate::cip {
namespace {

struct Described final : Description {
    const Device& device() const override { return device_; }
    std::optional<AssemblyInfo> assembly(std::uint32_t i) const override {
        using Role = AssemblyInfo::Role;
        if (i == 101 || i == 1041) return AssemblyInfo{Role::input, 32};
        if (i == 151 || i == 2041) return AssemblyInfo{Role::output, 32, i == 151 ? 101u : 1041u};
        return AssemblyInfo{i == 197 ? Role::listen_only : i == 198 ? Role::input_only : Role::configuration, 0};
    }
    const std::vector<std::uint32_t>& assemblies() const override { return list_; }
    std::uint32_t parameters() const override { return static_cast<std::uint32_t>(parameters_.size()); }
    std::optional<ParameterInfo> parameter(std::uint32_t i) const override { return parameters_.at(i - 1); }
    Device device_;
    std::vector<ParameterInfo> parameters_;
    std::vector<std::uint32_t> list_{101, 151, 197, 198, 199, 1041, 2041};
};
const char* broken(const Described& d, const std::string& name) {
    const auto called = [&](std::uint32_t) { return name; };
    return laws::broken_by(d, {name, name, name, called, called});
}

TEST(CipEds, WhatIsWrittenIsReadAsTheSame) {
    std::mt19937 random(18);
    const auto upto = [&](std::size_t most) { return random() % (most + 1); };
    const auto text = [&](std::size_t most) {
        // The sheet's own special characters are more frequent than others.
        static constexpr char special[] = "\"\\;,=$[]\r\n\t ";
        std::string s(upto(most), ' ');
        for (char& c : s)
            c = upto(3) == 0 ? special[upto(sizeof special - 2)] : static_cast<char>(upto(255));
        return s;
    };
    static constexpr DataType types[] = {DataType::boolean, DataType::sint,  DataType::int16,       DataType::dint,
                                         DataType::lint,    DataType::usint, DataType::uint16,      DataType::udint,
                                         DataType::real,    DataType::lreal, DataType::short_string};
    for (int round = 0; round < 300; ++round) {
        Described d;
        d.device_.name = text(40);
        for (std::size_t i = upto(8); i > 0; --i) {
            ParameterInfo p{text(40), text(20), text(80), types[upto(10)], true, upto(1) == 1, {}, {}, {}, {}};
            for (Bytes* b : {&p.min, &p.max, &p.fallback}) {
                b->resize(size_of(p.type));
                for (auto& byte : *b)
                    byte = upto(2) == 0 ? 0xFF : static_cast<std::uint8_t>(upto(255));
            }
            for (std::size_t n = upto(3); n > 0; --n)
                p.allowed.emplace_back(static_cast<std::int64_t>(random()) << 32 | random(), text(80));
            d.parameters_.push_back(std::move(p));
        }
        const char* const law = broken(d, text(60));
        ASSERT_EQ(law, nullptr) << law << ", round " << round;
    }
}

TEST(CipEds, NumbersWithoutAFormAreLeftOut) {
    Described d;
    ParameterInfo p;
    p.type = DataType::real;
    put32(p.min, std::bit_cast<std::uint32_t>(-std::numeric_limits<float>::infinity()));
    put32(p.max, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max()));
    put32(p.fallback, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
    d.parameters_.push_back(p);
    EXPECT_EQ(broken(d, "x"), nullptr);
    laws::Entries sheet;
    const auto called = [](std::uint32_t) { return std::string("x"); };
    ASSERT_TRUE(laws::read_sheet(eds_text(d, {"x", "x", "x", called, called}), sheet));
    const auto& fields = sheet["Params"]["Param1"];
    EXPECT_EQ(fields.at(9), "");
    EXPECT_EQ(laws::number_in(fields.at(10), DataType::real), p.max);
    EXPECT_EQ(fields.at(11), "");
}

TEST(CipEds, TheReaderRefusesWhatIsNoSheet) {
    for (const char* text : {"[A]\r\n B = \"x;\r\n", "[A]\r\n B = 1;\r\n B = 2;\r\n", "[A]\r\n B = 1\r\n", "[A]\r\n B = 1;", "B = 1;\r\n",
                             "[A]\r\n B = \x7F;\r\n"}) {
        laws::Entries sheet;
        EXPECT_FALSE(laws::read_sheet(text, sheet)) << text;
    }
}
}  // namespace
}  // namespace axisgate::cip
