# SPDX-License-Identifier: GPL-3.0-or-later
# generated/core/version.hpp: version, commit, compiler.
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE GDESP_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT GDESP_COMMIT)
  set(GDESP_COMMIT unknown)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${CMAKE_BINARY_DIR}/generated/core/version.hpp @ONLY)
