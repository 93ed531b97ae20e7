# SPDX-License-Identifier: GPL-3.0-or-later
# gdesp_options: what every target of the project is compiled with.
add_library(gdesp_options INTERFACE)
target_include_directories(gdesp_options INTERFACE ${CMAKE_SOURCE_DIR}/lib ${CMAKE_BINARY_DIR}/generated)
target_compile_options(gdesp_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${GDESP_WERROR}>>:-Werror>)
if(GDESP_SANITIZE)
  target_compile_options(gdesp_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${GDESP_SANITIZE} -fno-omit-frame-pointer -g>)
  target_link_options(gdesp_options INTERFACE -fsanitize=${GDESP_SANITIZE})
endif()
