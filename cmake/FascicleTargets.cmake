# The functions by which every library, program and test of the project is declared,
# so that flags, aliases and include paths are decided in one place.

add_library(fascicle_flags INTERFACE)
add_library(fascicle::flags ALIAS fascicle_flags)
target_compile_features(fascicle_flags INTERFACE cxx_std_20)
# -ffp-contract=off: results must not depend on where the compiler finds a fused multiply-add.
target_compile_options(fascicle_flags INTERFACE
  $<BUILD_INTERFACE:-march=x86-64-v2 -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wshadow -Wno-psabi>
  # GCC 12 sees overlaps in string concatenations that are none (its bug 105651).
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>)
target_include_directories(fascicle_flags INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:include/fascicle>)
if(FASCICLE_SANITIZE STREQUAL "address")
  # The tests' own code is checked for addresses alone: the other checks take as long to compile as the code itself.
  target_compile_options(fascicle_flags INTERFACE
    $<BUILD_INTERFACE:-fsanitize=address -fno-sanitize-recover=all -fno-omit-frame-pointer>
    $<BUILD_INTERFACE:$<$<NOT:$<BOOL:$<TARGET_PROPERTY:FASCICLE_TEST>>>:-fsanitize=undefined>>)
  target_link_options(fascicle_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=address,undefined>)
elseif(FASCICLE_SANITIZE STREQUAL "thread")
  target_compile_options(fascicle_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=thread -fno-omit-frame-pointer>)
  target_link_options(fascicle_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=thread>)
elseif(NOT FASCICLE_SANITIZE STREQUAL "")
  message(FATAL_ERROR "FASCICLE_SANITIZE is '${FASCICLE_SANITIZE}'; it takes: (empty), address, thread")
endif()

# fascicle_library(NAME [LOCAL] SOURCES a.cpp ... [PUBLIC lib ...] [PRIVATE lib ...])
# Makes the static library fascicle_NAME with the alias fascicle::NAME and, unless LOCAL, marks it for install.
function(fascicle_library name)
  cmake_parse_arguments(arg "LOCAL" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(fascicle_${name} STATIC ${arg_SOURCES})
  add_library(fascicle::${name} ALIAS fascicle_${name})
  set_target_properties(fascicle_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(fascicle_${name} PUBLIC fascicle::flags ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  if(NOT arg_LOCAL)
    set_property(GLOBAL APPEND PROPERTY FASCICLE_INSTALL_TARGETS fascicle_${name})
  endif()
endfunction()

# fascicle_program(NAME SOURCES a.cpp ... [PRIVATE lib ...])
function(fascicle_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;PRIVATE" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE fascicle::flags ${arg_PRIVATE})
endfunction()

# What the thread sanitizer's build needs: the test programs with the label `engine`.
add_custom_target(engine_tests)

# fascicle_test(NAME SOURCES a_test.cpp ... [PRIVATE lib ...] [LABELS label ...])
# One GoogleTest program; each of its cases becomes a CTest test.
function(fascicle_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;PRIVATE;LABELS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE fascicle::flags ${arg_PRIVATE} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE FASCICLE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${name} PROPERTIES FASCICLE_TEST ON)
  if("engine" IN_LIST arg_LABELS)
    add_dependencies(engine_tests ${name})
  endif()
  set(properties TIMEOUT 600)
  if(arg_LABELS)
    list(APPEND properties LABELS "${arg_LABELS}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${name}." PROPERTIES ${properties})
endfunction()
