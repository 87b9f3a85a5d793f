# Finds nvcc and sets SHALLOW_SAND_WITH_CUDA.
set(SHALLOW_SAND_CUDA AUTO CACHE STRING "CUDA backend: AUTO (if nvcc is found), ON or OFF")
set_property(CACHE SHALLOW_SAND_CUDA PROPERTY STRINGS AUTO ON OFF)

# What is compiled for 80 runs on 86 and 89, too.
set(SHALLOW_SAND_CUDA_ARCHITECTURES 75 80 90 CACHE STRING
  "GPUs to compile for, by compute capability without its dot; the newest is embedded as PTX, too")

set(SHALLOW_SAND_WITH_CUDA FALSE)
if(SHALLOW_SAND_CUDA STREQUAL "OFF")
  message(STATUS "CUDA backend: off (SHALLOW_SAND_CUDA=OFF)")
  return()
endif()

find_program(SHALLOW_SAND_NVCC nvcc PATHS /usr/local/cuda/bin /usr/bin)
if(NOT SHALLOW_SAND_NVCC)
  if(SHALLOW_SAND_CUDA STREQUAL "ON")
    message(FATAL_ERROR "SHALLOW_SAND_CUDA=ON, but nvcc is neither on the PATH nor in /usr/local/cuda/bin")
  endif()
  message(STATUS "CUDA backend: off (nvcc not found); the CPU backend does everything")
  return()
endif()
set(ENV{CUDACXX} ${SHALLOW_SAND_NVCC})
include(CheckLanguage)
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER)
  if(SHALLOW_SAND_CUDA STREQUAL "ON")
    message(FATAL_ERROR "SHALLOW_SAND_CUDA=ON, but ${SHALLOW_SAND_NVCC} cannot compile (see CMakeFiles/CMakeError.log)")
  endif()
  message(STATUS "CUDA backend: off (${SHALLOW_SAND_NVCC} cannot compile); the CPU backend does everything")
  return()
endif()

# Architectures are given as -gencode flags: CMake 3.16 knows no other way. Those that this nvcc lacks are left out; the
# newest is embedded as PTX, too, for GPUs that are newer still.
execute_process(COMMAND ${SHALLOW_SAND_NVCC} --list-gpu-code OUTPUT_VARIABLE known_codes ERROR_QUIET)
set(gencode "")
foreach(architecture ${SHALLOW_SAND_CUDA_ARCHITECTURES})
  if(known_codes MATCHES "sm_${architecture}" OR NOT known_codes)
    string(APPEND gencode " -gencode=arch=compute_${architecture},code=sm_${architecture}")
    set(newest ${architecture})
  endif()
endforeach()
string(APPEND gencode " -gencode=arch=compute_${newest},code=compute_${newest}")

# test/cuda/check_resources.py reads the kernels, which it can only where this nvcc is able to leave them uncompressed.
set(SHALLOW_SAND_READABLE_KERNELS FALSE)
set(uncompressed "")
execute_process(COMMAND ${SHALLOW_SAND_NVCC} --help OUTPUT_VARIABLE known_options ERROR_QUIET)
if(known_options MATCHES "--no-compress ")
  set(SHALLOW_SAND_READABLE_KERNELS TRUE)
  set(uncompressed " --no-compress")
endif()

set(CMAKE_CUDA_ARCHITECTURES OFF)
set(CMAKE_CUDA_STANDARD 17)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
set(CMAKE_CUDA_RUNTIME_LIBRARY Shared)
# 20012: Eigen's own headers.
string(APPEND CMAKE_CUDA_FLAGS
  "${gencode}${uncompressed} --fmad=false --expt-relaxed-constexpr -Werror=all-warnings --diag-suppress=20012"
  " -Xcompiler=-Wall,-Wextra,-Werror,-ffp-contract=off,-fno-math-errno,-fno-trapping-math")
enable_language(CUDA)
set(SHALLOW_SAND_WITH_CUDA TRUE)
message(STATUS "CUDA backend: on (${SHALLOW_SAND_NVCC})")
