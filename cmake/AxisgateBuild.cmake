# How rooms, families, suites and embedded files become targets. Folder names are the only list there is.

add_library(axisgate_flags INTERFACE)
target_compile_options(axisgate_flags INTERFACE -Wall -Wextra -Wpedantic -Werror -Wconversion -Wno-sign-conversion
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wformat=2 -Wnull-dereference)
if(NOT CMAKE_UNITY_BUILD)  # where files are compiled together, a local hides another file's private name
  target_compile_options(axisgate_flags INTERFACE -Wshadow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC 12 sees these in Boost and libstdc++ headers, where they are wrong (GCC PR 105562, 105651, 108076).
  target_compile_options(axisgate_flags INTERFACE -Wno-null-dereference -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow
    -Wno-array-bounds -Wno-stringop-overread -Wno-dangling-pointer)
endif()
target_compile_definitions(axisgate_flags INTERFACE AXISGATE_VERSION="${PROJECT_VERSION}" BOOST_ASIO_NO_DEPRECATED
  SPDLOG_FMT_EXTERNAL $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
if(AXISGATE_SANITIZE)
  add_compile_options(-fsanitize=${AXISGATE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${AXISGATE_SANITIZE})
  if(AXISGATE_SANITIZE MATCHES undefined)
    # vptr opens a pipe to see whether memory is readable: in a test that has used up all descriptors it sees faults that are none.
    # object-size tells of accesses that AddressSanitizer sees as well, and is half of the optimizer's time.
    add_compile_options(-fno-sanitize=vptr,object-size)
  endif()
  if(AXISGATE_SANITIZE MATCHES address AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # Checks of memory are calls instead of code at each place: a quarter of the compiler's time, and the same faults are found.
    add_compile_options("SHELL:-mllvm -asan-instrumentation-with-call-threshold=0")
  endif()
  if(AXISGATE_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Asio's fences, which ThreadSanitizer does not model: they stand beside mutexes of Asio that it does.
    add_compile_options(-Wno-tsan)
  endif()
endif()
# What is under test counts its edges for the fuzzers; the tests themselves do not.
set(AXISGATE_COVERAGE "")
if(AXISGATE_FUZZ)
  set(AXISGATE_COVERAGE -fsanitize=fuzzer-no-link)
endif()

# Where CMAKE_UNITY_BUILD is on (the presets that build everything), the files of a target are compiled some at a time: headers and their
# templates are then read once for all of them, which is half of the time. A name in an unnamed namespace is therefore used once in a target.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)

find_program(CCACHE ccache)
if(CCACHE)
  set(launch ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launch})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launch})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# Precompiled headers, one per kind, made once and shared by all targets of the kind: `core` for what is pure, `net` for what has sockets,
# `test` for the suites. All targets of a kind have the same compile options, or the compiler would not take the header.
# CMAKE_DISABLE_PRECOMPILE_HEADERS (preset clang) shows whether every file names what it uses.
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  set(AXISGATE_PCH_OPTIONS -Xclang -fno-pch-timestamp)  # so that ccache knows it again
endif()
set(AXISGATE_PCH_core <boost/json.hpp> <fmt/core.h> <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <deque> <functional> <map>
    <memory> <optional> <set> <span> <sstream> <string> <string_view> <unordered_map> <utility> <variant> <vector>)
set(AXISGATE_PCH_net <boost/asio.hpp> <boost/beast.hpp> ${AXISGATE_PCH_core} <atomic> <condition_variable> <mutex> <thread>)
set(AXISGATE_PCH_test <gtest/gtest.h> <gmock/gmock.h> ${AXISGATE_PCH_net} <fstream> <future> <iostream> <random>)

# Options that a precompiled header and its users must have in common.
function(axisgate_options target kind)
  target_link_libraries(${target} PRIVATE axisgate_flags)
  target_compile_options(${target} PRIVATE ${AXISGATE_PCH_OPTIONS})
  if(kind STREQUAL test)
    # A test runs once: to compile it quickly is worth more than to run it quickly. What it tests is optimized.
    target_compile_options(${target} PRIVATE -Wno-dangling-else $<$<NOT:$<CONFIG:Debug>>:-O0> $<$<NOT:$<CONFIG:Debug>>:-g0>)
  else()
    target_compile_options(${target} PRIVATE ${AXISGATE_COVERAGE})
    if(AXISGATE_SANITIZE AND kind STREQUAL net)
      # What stands on Asio is half of what a build with sanitizers waits for, mostly optimizing templates, and waits itself when it runs.
      target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O0>)
    endif()
  endif()
endfunction()

function(axisgate_pch target kind)
  axisgate_options(${target} ${kind})
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  if(NOT TARGET axisgate_pch_${kind})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/pch_${kind}.cpp CONTENT "// Generated: what the precompiled header belongs to.\n")
    add_library(axisgate_pch_${kind} OBJECT ${PROJECT_BINARY_DIR}/generated/pch_${kind}.cpp)
    target_link_libraries(axisgate_pch_${kind} PRIVATE Boost::json fmt::fmt)
    if(kind STREQUAL test)
      target_link_libraries(axisgate_pch_${kind} PRIVATE GTest::gmock)
    endif()
    axisgate_options(axisgate_pch_${kind} ${kind})
    target_precompile_headers(axisgate_pch_${kind} PRIVATE ${AXISGATE_PCH_${kind}})
  endif()
  target_precompile_headers(${target} REUSE_FROM axisgate_pch_${kind})
endfunction()

# axisgate_room(NAME FOLDER [ALSO FOLDER...] [LINKS ...] [PCH kind]): every .cpp of the folders (not below them) becomes the library axisgate::NAME.
function(axisgate_room name folder)
  cmake_parse_arguments(A "" "PCH" "LINKS;ALSO" ${ARGN})
  set(patterns "")
  foreach(f ${folder} ${A_ALSO})
    list(APPEND patterns ${PROJECT_SOURCE_DIR}/${f}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  if(sources)
    add_library(axisgate_${name} STATIC ${sources})
    target_include_directories(axisgate_${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(axisgate_${name} PUBLIC ${A_LINKS})
    if(NOT A_PCH)
      set(A_PCH core)
    endif()
    axisgate_pch(axisgate_${name} ${A_PCH})
  else()
    add_library(axisgate_${name} INTERFACE)
    target_include_directories(axisgate_${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(axisgate_${name} INTERFACE ${A_LINKS})
  endif()
  add_library(axisgate::${name} ALIAS axisgate_${name})
endfunction()

# axisgate_idl(TARGET FILE.idl): the C types of a DDS description, made by Cyclone's idlc; its header is a system header, so that nobody's
# warnings but its own maker's are asked of it.
function(axisgate_idl target file)
  find_program(IDLC idlc REQUIRED)
  get_filename_component(name ${file} NAME_WE)
  get_filename_component(path ${file} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
  set(dir ${PROJECT_BINARY_DIR}/generated/idl)
  file(MAKE_DIRECTORY ${dir})
  add_custom_command(OUTPUT ${dir}/${name}.c ${dir}/${name}.h COMMAND ${IDLC} -o ${dir} ${path} DEPENDS ${path} VERBATIM)
  add_library(${target} STATIC ${dir}/${name}.c ${dir}/${name}.h)
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  target_include_directories(${target} SYSTEM PUBLIC ${dir})
  target_link_libraries(${target} PUBLIC CycloneDDS::ddsc)
endfunction()

# One family per folder that has a family.cpp. Two targets each: the twin does not link the adapter's packing code.
# NOT_SHIPPED: families that the suites have (axisgate::families_tested) and the program has not (axisgate::families).
function(axisgate_families)
  cmake_parse_arguments(A "" "" "NOT_SHIPPED" ${ARGN})
  file(GLOB folders CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/adapters/*/family.cpp)
  set(names "")
  foreach(f ${folders})
    get_filename_component(dir ${f} DIRECTORY)
    get_filename_component(name ${dir} NAME)
    if(NOT EXISTS ${PROJECT_SOURCE_DIR}/schema/families/${name}.json)
      message(FATAL_ERROR "adapters/${name} has no catalogue: write schema/families/${name}.json")
    endif()
    list(APPEND names ${name})
    file(GLOB all CONFIGURE_DEPENDS ${dir}/*.cpp)
    file(GLOB twin CONFIGURE_DEPENDS ${dir}/twin/*.cpp ${dir}/twin*.cpp)
    list(REMOVE_ITEM all ${twin})
    add_library(axisgate_${name}_twin STATIC ${twin})
    target_link_libraries(axisgate_${name}_twin PUBLIC axisgate::core axisgate::canopen axisgate::mirror)
    axisgate_pch(axisgate_${name}_twin core)
    add_library(axisgate_${name} STATIC ${all})
    target_link_libraries(axisgate_${name} PUBLIC axisgate::core axisgate::axis axisgate::drive axisgate::canopen axisgate::mirror
                          PRIVATE axisgate_${name}_twin)
    axisgate_pch(axisgate_${name} core)
  endforeach()
  # A family that stands on another one says so in its own folder: it uses that family's adapter and twin.
  foreach(name ${names})
    set(says ${PROJECT_SOURCE_DIR}/adapters/${name}/stands_on.txt)
    if(EXISTS ${says})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${says})
      file(STRINGS ${says} base)
      target_link_libraries(axisgate_${name} PUBLIC axisgate_${base})
      target_link_libraries(axisgate_${name}_twin PUBLIC axisgate_${base}_twin)
    endif()
  endforeach()
  set(shipped ${names})
  list(REMOVE_ITEM shipped ${A_NOT_SHIPPED})
  axisgate_family_list(families ${shipped})
  axisgate_family_list(families_tested ${names})
  set(AXISGATE_FAMILY_NAMES ${names} PARENT_SCOPE)
endfunction()

# axisgate_family_list(TARGET name...): the library axisgate::TARGET with these families and the list of them.
function(axisgate_family_list target)
  set(declare "")
  set(list "")
  foreach(n ${ARGN})
    string(APPEND declare "const Family& family_${n}();\n")
    string(APPEND list "        &family_${n}(),\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/${target}.cpp CONTENT
"// Generated from the folders of adapters/: the list of families.
#include \"gateway/core/family.hpp\"
#include <array>
#include <vector>
namespace axisgate {
@declare@
std::span<const Family* const> all_families() {
    static const std::vector<const Family*> families{
@list@    };
    return families;
}
const Family* find_family(std::string_view name) {
    for (const Family* f : all_families()) {
        if (f->name == name) return f;
    }
    return nullptr;
}
}  // namespace axisgate
" @ONLY)
  add_library(axisgate_${target} STATIC ${PROJECT_BINARY_DIR}/generated/${target}.cpp)
  target_link_libraries(axisgate_${target} PUBLIC axisgate::core PRIVATE axisgate_flags)
  foreach(n ${ARGN})
    target_link_libraries(axisgate_${target} PUBLIC axisgate_${n})
  endforeach()
  add_library(axisgate::${target} ALIAS axisgate_${target})
endfunction()

# axisgate_embed(TARGET path... [WITHOUT path...]): files and folders inside the program, found by their path (gateway/core/assets.hpp).
function(axisgate_embed target)
  cmake_parse_arguments(A "" "" "WITHOUT" ${ARGN})
  set(files "")
  foreach(p ${A_UNPARSED_ARGUMENTS})
    if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${p})
      file(GLOB_RECURSE found CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${p}/*)
      list(APPEND files ${found})
    elseif(EXISTS ${PROJECT_SOURCE_DIR}/${p})
      list(APPEND files ${p})
    endif()
  endforeach()
  if(A_WITHOUT)
    list(REMOVE_ITEM files ${A_WITHOUT})
  endif()
  set(asm ".section .rodata\n")
  set(table "")
  set(extern "")
  set(i 0)
  foreach(f ${files})
    string(APPEND asm ".globl axisgate_asset_${i}\n.globl axisgate_asset_${i}_end\naxisgate_asset_${i}:\n.incbin \"${PROJECT_SOURCE_DIR}/${f}\"\naxisgate_asset_${i}_end:\n.byte 0\n")
    string(APPEND extern "extern const char axisgate_asset_${i}[];\nextern const char axisgate_asset_${i}_end[];\n")
    string(APPEND table "    {\"${f}\", {axisgate_asset_${i}, static_cast<std::size_t>(axisgate_asset_${i}_end - axisgate_asset_${i})}},\n")
    math(EXPR i "${i}+1")
    list(APPEND depends ${PROJECT_SOURCE_DIR}/${f})
  endforeach()
  string(APPEND asm ".section .note.GNU-stack,\"\",@progbits\n")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/${target}.S CONTENT "${asm}" @ONLY)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/${target}.cpp CONTENT
"// Generated: the files that live inside the program.
#include \"gateway/core/assets.hpp\"
#include <vector>
extern \"C\" {
@extern@}
namespace axisgate {
std::span<const Asset> all_assets() {
    static const std::vector<Asset> assets{
@table@    };
    return assets;
}
}  // namespace axisgate
" @ONLY)
  add_library(${target} STATIC ${PROJECT_BINARY_DIR}/generated/${target}.S ${PROJECT_BINARY_DIR}/generated/${target}.cpp)
  set_source_files_properties(${PROJECT_BINARY_DIR}/generated/${target}.S PROPERTIES OBJECT_DEPENDS "${depends}")
  target_link_libraries(${target} PUBLIC axisgate::core)
endfunction()

# One test program per folder of tests/unit, plus conformance and world, plus adapters/<family>/tests.
# ONLY and NOT are file name patterns: an adapter's tests and its twin's are two programs, as they are two readings.
# DOORS registers the program's doors in it.
function(axisgate_test_program name folder)
  cmake_parse_arguments(A "DOORS" "ONLY;NOT" "LINKS" ${ARGN})
  if(NOT A_ONLY)
    set(A_ONLY "*.cpp")
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/${A_ONLY})
  if(A_NOT)
    file(GLOB others CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/${A_NOT})
    list(REMOVE_ITEM sources ${others})
  endif()
  if(NOT sources)
    return()
  endif()
  if(A_DOORS)
    list(APPEND sources ${PROJECT_SOURCE_DIR}/tests/every_door.cpp)
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${A_LINKS} GTest::gmock GTest::gtest_main Boost::json fmt::fmt)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE AXISGATE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  axisgate_pch(${name} test)
  add_dependencies(tests_all ${name})
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300 LABELS ${name})
endfunction()

function(axisgate_test_suites)
  add_custom_target(tests_all)
  axisgate_test_program(test_core tests/unit/core DOORS LINKS axisgate::core axisgate::axis)
  axisgate_test_program(test_site tests/unit/site DOORS LINKS axisgate::site axisgate::registers)
  axisgate_test_program(test_axis tests/unit/axis DOORS LINKS axisgate::axis)
  axisgate_test_program(test_drive tests/unit/drive LINKS axisgate::drive)
  axisgate_test_program(test_canopen tests/unit/canopen LINKS axisgate::canopen)
  axisgate_test_program(test_cip tests/unit/cip LINKS axisgate::cip)
  axisgate_test_program(test_wire tests/unit/wire LINKS axisgate::wire)
  axisgate_test_program(test_services tests/unit/services DOORS LINKS axisgate::services)
  target_sources(test_services PRIVATE tests/unit/http/fake_gateway.cpp)  # the ports' doubles
  axisgate_test_program(test_lines tests/unit/lines LINKS axisgate::lines)
  axisgate_test_program(test_store tests/unit/store DOORS LINKS axisgate::store axisgate_assets)
  axisgate_test_program(test_modbus tests/unit/modbus DOORS LINKS axisgate::door_modbus)
  axisgate_test_program(test_registers tests/unit/registers DOORS LINKS axisgate::door_modbus axisgate_assets)  # asked as a client of the Modbus door asks
  axisgate_test_program(test_enip tests/unit/enip DOORS LINKS axisgate::door_enip axisgate_assets)
  axisgate_test_program(test_dds tests/unit/dds DOORS LINKS axisgate::door_dds)
  if(TARGET test_dds)
    target_sources(test_dds PRIVATE tests/unit/http/fake_gateway.cpp)  # the ports' doubles
    # The same types as a later version may have them, each with one member more; in C they have names of their own.
    file(READ ${PROJECT_SOURCE_DIR}/schema/axisgate.idl idl)
    string(REPLACE "\n  };" "\n    long long of_a_later_version;\n  };" idl "${idl}")
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/later.idl CONTENT "${idl}" @ONLY)
    axisgate_idl(axisgate_idl_later ${PROJECT_BINARY_DIR}/generated/later.idl)
    foreach(t GatewayState AxisState Event AxisCommand CommandResult ParameterWrite SetPoint)
      target_compile_definitions(axisgate_idl_later PRIVATE axisgate_${t}=later_${t} axisgate_${t}_desc=later_${t}_desc)
    endforeach()
    target_link_libraries(test_dds PRIVATE axisgate_idl_later)
  endif()
  axisgate_test_program(test_http tests/unit/http DOORS LINKS axisgate::door_http axisgate_assets)
  axisgate_test_program(test_runtime tests/unit/runtime DOORS LINKS axisgate::runtime axisgate_assets)
  target_sources(test_runtime PRIVATE tests/unit/store/fault_vfs.cpp)  # the disk that fails
  foreach(f ${AXISGATE_FAMILY_NAMES})
    axisgate_test_program(test_${f} adapters/${f}/tests NOT twin*.cpp LINKS axisgate_${f} axisgate_${f}_twin axisgate::wire)
    axisgate_test_program(test_${f}_twin adapters/${f}/tests ONLY twin*.cpp LINKS axisgate_${f}_twin axisgate::wire)
  endforeach()
  axisgate_test_program(test_conformance tests/conformance DOORS LINKS axisgate::families_tested axisgate::engine axisgate::registers axisgate::door_enip axisgate::services axisgate_assets_tested)
  target_sources(test_conformance PRIVATE tests/world/specimen_day.cpp)  # the laws that the world asks of drawn specimens, too
  axisgate_test_program(test_world tests/world DOORS LINKS axisgate::families_tested axisgate::engine axisgate::services axisgate_assets_tested)
endfunction()

# tests/fuzz/*.cpp and adapters/<family>/fuzz/*.cpp: one libFuzzer program each, named fuzz_<file>.
function(axisgate_fuzz_targets)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/fuzz/*.cpp)
  foreach(f ${AXISGATE_FAMILY_NAMES})
    file(GLOB own CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/adapters/${f}/fuzz/*.cpp)
    list(APPEND sources ${own})
  endforeach()
  # The gateway as the HTTP door's tests see it, for the targets that go through its router.
  add_library(axisgate_fuzz_gateway STATIC ${PROJECT_SOURCE_DIR}/tests/unit/http/fake_gateway.cpp)
  target_link_libraries(axisgate_fuzz_gateway PUBLIC axisgate::door_http)
  axisgate_pch(axisgate_fuzz_gateway net)
  # What several targets share.
  file(GLOB laws CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/fuzz/laws/*.cpp)
  add_library(axisgate_fuzz_laws STATIC ${laws})
  target_link_libraries(axisgate_fuzz_laws PUBLIC axisgate::families_tested axisgate::axis axisgate_assets_tested)
  axisgate_pch(axisgate_fuzz_laws net)
  foreach(s ${sources})
    get_filename_component(n ${s} NAME_WE)
    add_executable(fuzz_${n} ${s} ${PROJECT_SOURCE_DIR}/tests/every_door.cpp)
    target_link_libraries(fuzz_${n} PRIVATE axisgate_fuzz_laws axisgate_fuzz_gateway axisgate::canopen axisgate::cip axisgate::runtime axisgate::door_modbus axisgate::door_http axisgate_assets_tested)
    axisgate_pch(fuzz_${n} net)
    target_link_options(fuzz_${n} PRIVATE -fsanitize=fuzzer)
    list(APPEND targets fuzz_${n})
  endforeach()
  add_custom_target(fuzz_all DEPENDS ${targets})
endfunction()
