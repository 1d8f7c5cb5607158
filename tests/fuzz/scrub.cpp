// Fuzz target: any text, with a password inserted in one of the usual forms. The program is aborted when the password remains, or when a
// second pass changes anything.
#include "gateway/runtime/scrub.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace axisgate;
    FuzzedDataProvider in(data, size);
    const std::string planted = "Zq7mQp";  // six characters that occur in no name
    const std::string ways[] = {"\npassword = \"" + planted + "\"\n",
                                "\n{\"token\":\"" + planted + "\"}\n",
                                "\nAuthorization: Bearer " + planted + "\n",
                                "\n://anna:" + planted + "@host/\n",
                                "\nsecret: " + planted + "\n",
                                "\n-----BEGIN KEY-----\n" + planted + "\n-----END KEY-----\n"};
    const std::string way = ways[in.ConsumeIntegralInRange<std::size_t>(0, 5)];
    std::string before = in.ConsumeRandomLengthString();
    const std::string after = in.ConsumeRemainingBytesAsString();
    if (before.find(planted) != std::string::npos || after.find(planted) != std::string::npos) return 0;
    const std::string once = scrub(before + way + after);
    fuzz::require(once.find(planted) == std::string::npos, "a planted password is taken out, whatever stands around it");
    fuzz::require(scrub(once) == once, "a second time changes nothing");
    return 0;
}
