// Words: every mnemonic of MCode with what the language must know of it before it runs a statement.
// In: letters of a line. Out: one enumerator, and its class, access, usage, products and constant range.
// Never holds a value, and knows nothing of motion: what a word does is for the interpreter and the motor.
//
// Source: summary tables [L582-1240] and the detail page of each word; where they differ the detail page decides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace axisgate::mcode::twin {

/// What a word is [L524-580].
enum class WordKind : std::uint8_t { instruction, variable, flag, setup, keyword, trip, math, reserved };
/// How its value may be used. `ro` also stands for what is cleared by reading; `wo` can be written and not printed.
enum class Access : std::uint8_t { none, ro, rw, wo };
/// Who keeps the value: the language (registers, program, communication) or the motor (motion, I/O, encoder, currents, hMT).
enum class Owner : std::uint8_t { language, motor };

/// Products as bits. Ethernet and the 42 mm frame are properties beside the product.
inline constexpr std::uint8_t lmdo = 1, lmdc = 2, lmm = 4;
inline constexpr std::uint8_t lmd = lmdo | lmdc, every = lmd | lmm, encoder = lmdc | lmm;

struct WordInfo {
    std::string_view text;
    WordKind kind;
    Access access;
    Owner owner;
    bool immediate;         ///< allowed as a typed line
    bool program;           ///< allowed in a stored program
    std::uint8_t products;  ///< others refuse it with error 37
    bool ranged;            ///< `min`..`max` hold always; else there is no range or it depends on other values
    double min;
    double max;
};

// X(word, kind, access, owner, immediate, program, products, ranged, min, max), in alphabetical order.
// clang-format off
#define AXISGATE_MCODE_WORDS(X) \
    X(A, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(AB, math, none, language, 0, 0, every, 0, 0, 0) \
    X(AF, flag, ro, motor, 1, 1, lmdc, 0, 0, 0) \
    X(AJ, variable, rw, motor, 1, 1, every, 1, 0, 127) \
    X(AL, keyword, ro, language, 1, 0, every, 0, 0, 0) \
    X(AO, variable, rw, motor, 1, 1, every, 1, 0, 4294967295.0) \
    X(AS, variable, rw, motor, 1, 1, lmdc, 1, 0, 3) \
    X(AT, variable, rw, motor, 1, 1, every, 1, 1, 3) \
    X(AV, variable, ro, motor, 1, 1, lmdc, 0, 0, 0) \
    X(BD, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(BE, flag, rw, motor, 1, 1, every, 1, 0, 1) \
    X(BL, variable, rw, motor, 1, 1, every, 1, -2147483648.0, 2147483647.0) \
    X(BM, variable, rw, motor, 1, 1, every, 1, 0, 1) \
    X(BP, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(BR, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(BY, flag, ro, language, 1, 1, every, 0, 0, 0) \
    X(C1, variable, rw, motor, 1, 1, every, 1, -2147483648.0, 2147483647.0) \
    X(C2, variable, rw, motor, 1, 1, encoder, 1, -2147483648.0, 2147483647.0) \
    X(CB, variable, rw, motor, 1, 1, lmdc, 1, 0, 3) \
    X(CE, flag, rw, language, 1, 1, every, 1, 0, 2) \
    X(CF, instruction, none, motor, 1, 1, lmdc, 0, 0, 0) \
    X(CK, variable, rw, language, 1, 1, every, 1, 0, 2) \
    X(CL, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(CP, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(CS, math, none, language, 0, 0, every, 0, 0, 0) \
    X(CW, variable, rw, motor, 1, 1, every, 1, 0, 255) \
    X(C_, math, none, language, 0, 0, every, 0, 0, 0) \
    X(D, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(D1, variable, rw, motor, 1, 1, every, 1, 0, 255) \
    X(D2, variable, rw, motor, 1, 1, every, 1, 0, 255) \
    X(D3, variable, rw, motor, 1, 1, every, 1, 0, 255) \
    X(D4, variable, rw, motor, 1, 1, every, 1, 0, 255) \
    X(D5, variable, rw, motor, 1, 1, every, 1, 0, 1000) \
    X(DB, variable, rw, motor, 1, 1, encoder, 1, 0, 65000) \
    X(DC, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(DE, flag, rw, motor, 1, 1, every, 1, 0, 1) \
    X(DG, flag, rw, language, 1, 1, every, 1, 0, 1) \
    X(DJ, variable, rw, motor, 1, 1, every, 1, 0, 127) \
    X(DN, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(DT, variable, rw, motor, 1, 1, every, 1, 1, 3) \
    X(E, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(EE, flag, rw, motor, 1, 1, encoder, 1, 0, 1) \
    X(EF, flag, ro, language, 1, 1, every, 0, 0, 0) \
    X(EL, variable, rw, motor, 1, 1, lmm, 1, 1, 2000) \
    X(EM, flag, rw, language, 1, 1, every, 1, 0, 3) \
    X(ER, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(ES, flag, rw, language, 1, 1, every, 1, 0, 3) \
    X(EX, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(F1, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F2, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F3, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F4, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F5, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F6, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F7, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(F8, variable, rw, language, 1, 1, every, 0, 0, 0) \
    X(FC, variable, rw, motor, 1, 1, every, 1, 0, 9) \
    X(FD, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(FL, flag, rw, motor, 1, 1, lmd, 1, 0, 1) \
    X(FM, variable, rw, motor, 1, 1, every, 1, 0, 9) \
    X(FS, variable, rw, motor, 1, 1, encoder, 1, -25600, 25600) \
    X(FT, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(H, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(HC, variable, rw, motor, 1, 1, every, 1, 0, 100) \
    X(HF, instruction, none, motor, 1, 1, encoder, 0, 0, 0) \
    X(HI, instruction, none, motor, 1, 1, encoder, 0, 0, 0) \
    X(HM, instruction, none, motor, 1, 1, every, 0, 0, 0) \
    X(HT, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(I1, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(I2, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(I3, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(I4, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(I5, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(I6, variable, ro, motor, 1, 1, encoder, 0, 0, 0) \
    X(I7, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I8, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I9, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I10, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I11, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I12, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(I13, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(IC, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(IF, flag, rw, language, 1, 1, every, 1, 0, 0) \
    X(IN, keyword, ro, motor, 1, 1, every, 0, 0, 0) \
    X(IP, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(IS, setup, rw, motor, 1, 1, every, 0, 0, 0) \
    X(IT, keyword, ro, motor, 1, 1, every, 0, 0, 0) \
    X(IV, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(JE, flag, rw, motor, 1, 1, every, 1, 0, 1) \
    X(L, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(LB, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(LD, variable, rw, motor, 1, 1, lmdc, 1, 0, 2147483647.0) \
    X(LG, variable, rw, motor, 1, 1, lmdc, 1, 0, 2147483647.0) \
    X(LK, flag, rw, language, 1, 1, every, 1, 0, 1) \
    X(LL, variable, ro, motor, 1, 1, lmdc, 0, 0, 0) \
    X(LM, variable, rw, motor, 1, 1, every, 1, 1, 6) \
    X(LO, math, none, language, 0, 0, every, 0, 0, 0) \
    X(LR, flag, ro, motor, 1, 1, lmdc, 0, 0, 0) \
    X(LS, setup, rw, motor, 1, 1, every, 0, 0, 0) \
    X(LT, variable, rw, motor, 1, 1, lmdc, 1, 2, 65535) \
    X(L_, math, none, language, 0, 0, every, 0, 0, 0) \
    X(MA, instruction, none, motor, 1, 1, every, 0, 0, 0) \
    X(MD, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(MF, variable, rw, motor, 1, 1, lmdc, 0, 0, 0) \
    X(MP, flag, ro, motor, 1, 1, every, 0, 0, 0) \
    X(MR, instruction, none, motor, 1, 1, every, 0, 0, 0) \
    X(MS, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(MT, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(MU, variable, rw, motor, 1, 1, lmdc, 1, 0, 2) \
    X(MV, flag, ro, motor, 1, 1, every, 0, 0, 0) \
    X(NE, flag, rw, language, 1, 1, every, 1, 0, 1) \
    X(O1, variable, wo, motor, 1, 1, every, 1, 0, 1) \
    X(O2, variable, wo, motor, 1, 1, every, 1, 0, 1) \
    X(O3, variable, wo, motor, 1, 1, every, 1, 0, 1) \
    X(OE, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(OF, variable, ro, motor, 1, 1, lmd, 0, 0, 0) \
    X(OS, setup, rw, motor, 1, 1, every, 0, 0, 0) \
    X(OT, variable, wo, motor, 1, 1, every, 1, 0, 7) \
    X(P, variable, rw, motor, 1, 1, every, 1, -2147483648.0, 2147483647.0) \
    X(PC, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(PF, setup, rw, language, 1, 1, every, 0, 0, 0) \
    X(PG, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(PI, math, ro, language, 0, 0, every, 0, 0, 0) \
    X(PK, reserved, none, language, 0, 0, every, 0, 0, 0) \
    X(PM, flag, rw, motor, 1, 1, encoder, 1, 0, 1) \
    X(PN, keyword, ro, language, 1, 1, every, 0, 0, 0) \
    X(PR, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(PS, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(PW, setup, rw, language, 1, 1, lmm, 0, 0, 0) \
    X(PY, flag, rw, language, 1, 1, every, 1, 0, 1) \
    X(QD, flag, rw, language, 1, 1, every, 1, 0, 1) \
    X(R1, variable, rw, language, 1, 1, every, 1, -2147483647.0, 2147483647.0) \
    X(R2, variable, rw, language, 1, 1, every, 1, -2147483647.0, 2147483647.0) \
    X(R3, variable, rw, language, 1, 1, every, 1, -2147483647.0, 2147483647.0) \
    X(R4, variable, rw, language, 1, 1, every, 1, -2147483647.0, 2147483647.0) \
    X(RA, variable, rw, language, 1, 1, every, 1, 0, 1) \
    X(RC, variable, rw, motor, 1, 1, every, 1, 1, 100) \
    X(RD, variable, rw, motor, 1, 1, every, 1, 0, 1) \
    X(RS, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(RT, instruction, none, language, 0, 1, every, 0, 0, 0) \
    X(S, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(SA, variable, rw, motor, 1, 1, lmm, 0, 0, 0) \
    X(SC, instruction, none, motor, 1, 1, lmdc, 0, 0, 0) \
    X(SF, variable, rw, motor, 1, 1, encoder, 1, 0, 65000) \
    X(SI, math, none, language, 0, 0, every, 0, 0, 0) \
    X(SL, instruction, none, motor, 1, 1, every, 0, 0, 0) \
    X(SM, variable, rw, motor, 1, 1, encoder, 1, 0, 1) \
    X(SN, keyword, ro, language, 1, 1, every, 0, 0, 0) \
    X(SQ, math, none, language, 0, 0, every, 0, 0, 0) \
    X(ST, flag, rw, motor, 1, 1, encoder, 1, 0, 0) \
    X(SU, keyword, none, language, 0, 1, every, 0, 0, 0) \
    X(S_, math, none, language, 0, 0, every, 0, 0, 0) \
    X(TA, trip, none, motor, 1, 1, lmdc, 0, 0, 0) \
    X(TC, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(TD, variable, rw, motor, 1, 1, lmdc, 1, 0, 1) \
    X(TE, variable, rw, language, 1, 1, every, 1, 0, 127) \
    X(TG, math, none, language, 0, 0, every, 0, 0, 0) \
    X(TI, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(TM, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(TP, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(TQ, variable, rw, motor, 1, 1, lmdc, 1, 1, 100) \
    X(TR, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(TS, variable, rw, motor, 1, 1, lmdc, 0, 0, 0) \
    X(TT, trip, none, motor, 1, 1, every, 0, 0, 0) \
    X(T_, math, none, language, 0, 0, every, 0, 0, 0) \
    X(UG, instruction, none, language, 1, 0, every, 0, 0, 0) \
    X(UV, keyword, ro, language, 1, 1, every, 0, 0, 0) \
    X(V, variable, ro, motor, 1, 1, every, 0, 0, 0) \
    X(VA, instruction, none, language, 1, 1, every, 0, 0, 0) \
    X(VC, flag, ro, motor, 1, 1, every, 0, 0, 0) \
    X(VF, variable, rw, motor, 1, 1, lmdc, 1, 0, 1000) \
    X(VI, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(VM, variable, rw, motor, 1, 1, every, 0, 0, 0) \
    X(VR, keyword, ro, language, 1, 1, every, 0, 0, 0) \
    X(VT, keyword, ro, motor, 1, 1, every, 0, 0, 0) \
    X(WT, variable, rw, motor, 1, 1, every, 1, 0, 84)
// clang-format on

enum class Word : std::uint16_t {
#define X(word, ...) word,
    AXISGATE_MCODE_WORDS(X)
#undef X
};

inline constexpr std::array words = {
#define X(word, kind, access, owner, immediate, program, products, ranged, min, max) \
    WordInfo{#word, WordKind::kind, Access::access, Owner::owner, (immediate) != 0, (program) != 0, products, (ranged) != 0, min, max},
    AXISGATE_MCODE_WORDS(X)
#undef X
};
#undef AXISGATE_MCODE_WORDS

[[nodiscard]] constexpr const WordInfo& info(Word w) noexcept { return words[static_cast<std::size_t>(w)]; }
[[nodiscard]] constexpr std::string_view text_of(Word w) noexcept { return info(w).text; }
/// `first` and the next ones by number: nth(Word::R1, 2) is R3.
[[nodiscard]] constexpr Word nth(Word first, int n) noexcept { return static_cast<Word>(static_cast<int>(first) + n); }
/// The word that these letters are, in any case of letters [L6871]; nothing for names of users.
[[nodiscard]] std::optional<Word> word_named(std::string_view letters) noexcept;
/// It came with firmware 6.0.01 [L1027-1130, L1228, L1266].
[[nodiscard]] bool came_with_6(Word w) noexcept;
/// IC and DC change it by one; mode and configuration words answer with error 26 [L2334-2338].
[[nodiscard]] bool countable(Word w) noexcept;

}  // namespace axisgate::mcode::twin
