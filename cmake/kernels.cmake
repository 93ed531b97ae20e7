# SPDX-License-Identifier: GPL-3.0-or-later
# One kernel source, both back ends: gdesp_kernel_sources(target file...) compiles each .cpp with the host
# compiler (exec::CompiledBackend is OpenMP there) and, when CUDA is on, once more through a generated one-line
# .cu (exec::CompiledBackend is Cuda there).
find_package(OpenMP REQUIRED COMPONENTS CXX)

set(GDESP_HAVE_CUDA OFF)
if(NOT GDESP_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX} AND EXISTS /usr/local/cuda/bin/nvcc)
    set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)
  endif()
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES ${GDESP_CUDA_ARCHITECTURES})
  endif()
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
      # CMake 3.25 does not know that nvcc 13 speaks C++20.
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
      list(APPEND CMAKE_CUDA_COMPILE_FEATURES cuda_std_20)
    endif()
    set(GDESP_HAVE_CUDA ON)
  elseif(GDESP_CUDA STREQUAL "ON")
    message(FATAL_ERROR "GDESP_CUDA=ON, but no nvcc was found (PATH, CUDACXX or /usr/local/cuda/bin)")
  endif()
endif()
if(GDESP_HAVE_CUDA)
  message(STATUS "CUDA back end: on (nvcc ${CMAKE_CUDA_COMPILER_VERSION}, architectures ${CMAKE_CUDA_ARCHITECTURES})")
else()
  message(STATUS "CUDA back end: off (no nvcc); the CPU back end does everything")
endif()

# Host flags of the solver: no reassociation, so that results do not depend on the vectoriser's choices.
set(GDESP_KERNEL_FLAGS -O3 -fno-math-errno -fno-trapping-math -fno-signed-zeros -ffp-contract=fast)
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  list(REMOVE_ITEM GDESP_KERNEL_FLAGS -O3)
endif()
if(GDESP_NATIVE)
  list(APPEND GDESP_KERNEL_FLAGS -march=native -mprefer-vector-width=512 -Wno-maybe-uninitialized -Wno-uninitialized)
endif()

function(gdesp_kernel_target target)
  target_link_libraries(${target} PUBLIC gdesp_options PRIVATE OpenMP::OpenMP_CXX)
  target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:${GDESP_KERNEL_FLAGS}>")
  if(GDESP_HAVE_CUDA)
    target_compile_definitions(${target} PUBLIC GDESP_HAVE_CUDA=1)
    target_compile_options(${target} PRIVATE
      "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;-lineinfo;-Xcompiler=-Wall;--resource-usage>")
    set_target_properties(${target} PROPERTIES CUDA_RUNTIME_LIBRARY Static POSITION_INDEPENDENT_CODE ON
      CUDA_STANDARD 20)
    target_link_libraries(${target} PUBLIC ${GDESP_CUDART_STATIC} dl rt pthread)
  endif()
endfunction()

if(GDESP_HAVE_CUDA)
  find_library(GDESP_CUDART_STATIC cudart_static
    PATHS ${CMAKE_CUDA_IMPLICIT_LINK_DIRECTORIES} ${CMAKE_CUDA_TOOLKIT_INCLUDE_DIRECTORIES}/../lib64 REQUIRED)
endif()

function(gdesp_kernel_sources target)
  foreach(source ${ARGN})
    target_sources(${target} PRIVATE ${source})
    if(GDESP_HAVE_CUDA)
      get_filename_component(absolute ${source} ABSOLUTE)
      file(RELATIVE_PATH relative ${CMAKE_SOURCE_DIR} ${absolute})
      string(REPLACE ".cpp" ".cu" wrapped ${CMAKE_BINARY_DIR}/generated/cuda/${relative})
      file(GENERATE OUTPUT ${wrapped} CONTENT "#include \"${absolute}\"\n")
      target_sources(${target} PRIVATE ${wrapped})
    endif()
  endforeach()
endfunction()
