# SPDX-License-Identifier: GPL-3.0-or-later
# gdesp_test(NAME name LABEL tier SOURCES file... LIBS target... [TIMEOUT s]): one GoogleTest program, one ctest
# entry. Tiers: unit verification validation regression stability cli gpu.
find_package(GTest REQUIRED)
function(gdesp_test)
  cmake_parse_arguments(T "" "NAME;LABEL;TIMEOUT" "SOURCES;LIBS" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  set(name ${T_LABEL}_${T_NAME})
  add_executable(${name} ${T_SOURCES})
  target_link_libraries(${name} PRIVATE ${T_LIBS} gdesp_options GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    GDESP_SOURCE_DIR="${CMAKE_SOURCE_DIR}" GDESP_BINARY_DIR="${CMAKE_BINARY_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  # Threads that wait spin briefly (exec::wait_briefly): tests share the machine with each other.
  set_tests_properties(${name} PROPERTIES LABELS ${T_LABEL} TIMEOUT ${T_TIMEOUT} ENVIRONMENT GOMP_SPINCOUNT=10000
    SKIP_REGULAR_EXPRESSION "\\[  PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$")  # all cases skipped, none failed
endfunction()
# gdesp_script_test(NAME name LABEL tier COMMAND ...): a shell-level test; exit 77 is a visible skip.
function(gdesp_script_test)
  cmake_parse_arguments(T "" "NAME;LABEL;TIMEOUT" "COMMAND" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  add_test(NAME ${T_LABEL}_${T_NAME} COMMAND ${T_COMMAND} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  set_tests_properties(${T_LABEL}_${T_NAME} PROPERTIES LABELS ${T_LABEL} TIMEOUT ${T_TIMEOUT} SKIP_RETURN_CODE 77
    ENVIRONMENT GOMP_SPINCOUNT=10000)
endfunction()
