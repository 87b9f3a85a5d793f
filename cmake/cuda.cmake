# Finds nvcc and sets SHALLOW_SAND_WITH_CUDA.
set(SHALLOW_SAND_CUDA AUTO CACHE STRING "CUDA backend: AUTO (if nvcc is found), ON or OFF")
set_property(CACHE SHALLOW_SAND_CUDA PROPERTY STRINGS AUTO ON OFF)

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

execute_process(COMMAND ${SHALLOW_SAND_NVCC} --list-gpu-code OUTPUT_VARIABLE known_codes ERROR_QUIET)

# For this machine's GPUs. Where this nvcc knows none of them, for the oldest that all from 11 to 13 know: newer GPUs translate its
# PTX when they first start.
find_program(SHALLOW_SAND_NVIDIA_SMI nvidia-smi)
mark_as_advanced(SHALLOW_SAND_NVIDIA_SMI)
set(own_architectures "")
if(SHALLOW_SAND_NVIDIA_SMI)
  execute_process(COMMAND ${SHALLOW_SAND_NVIDIA_SMI} --query-gpu=compute_cap --format=csv,noheader
    OUTPUT_VARIABLE capabilities ERROR_QUIET)
  string(REGEX MATCHALL "[0-9]+\\.[0-9]" capabilities "${capabilities}")
  foreach(capability ${capabilities})
    string(REPLACE "." "" architecture ${capability})
    if(known_codes MATCHES "sm_${architecture}" AND NOT architecture IN_LIST own_architectures)
      list(APPEND own_architectures ${architecture})
    endif()
  endforeach()
endif()
if(NOT own_architectures)
  set(own_architectures 75)
endif()
set(SHALLOW_SAND_CUDA_ARCHITECTURES ${own_architectures} CACHE STRING
  "GPUs to compile for, by compute capability without its dot; the newest is embedded as PTX, too")

# Architectures are given as -gencode flags: CMake 3.16 knows no other way. Those that this nvcc lacks are left out; the
# newest is embedded as PTX, too, for GPUs that are newer still.
set(gencode "")
set(newest 0)
foreach(architecture ${SHALLOW_SAND_CUDA_ARCHITECTURES})
  if(known_codes MATCHES "sm_${architecture}" OR NOT known_codes)
    string(APPEND gencode " -gencode=arch=compute_${architecture},code=sm_${architecture}")
    if(architecture GREATER newest)
      set(newest ${architecture})
    endif()
  endif()
endforeach()
if(newest EQUAL 0)
  message(FATAL_ERROR "SHALLOW_SAND_CUDA_ARCHITECTURES is ${SHALLOW_SAND_CUDA_ARCHITECTURES}, of which ${SHALLOW_SAND_NVCC} knows "
    "none: give others (nvcc --list-gpu-code names them; 75 runs on all newer GPUs, too), or SHALLOW_SAND_CUDA=OFF")
endif()
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
# The standard and the shared runtime are flags, too, for CMake 3.16 has no words for them. 20012: headers of Eigen 3.4; no-cpp: of 3.3.
set(CMAKE_CUDA_RUNTIME_LIBRARY Shared)
string(APPEND CMAKE_CUDA_FLAGS
  " -std=c++17 --cudart=shared${gencode}${uncompressed} --fmad=false --expt-relaxed-constexpr -Werror=all-warnings --diag-suppress=20012"
  " -Xcompiler=-Wall,-Wextra,-Werror,-Wno-cpp,-ffp-contract=off,-fno-math-errno,-fno-trapping-math")
enable_language(CUDA)
set(SHALLOW_SAND_WITH_CUDA TRUE)
string(REPLACE ";" ", " listed "${SHALLOW_SAND_CUDA_ARCHITECTURES}")
message(STATUS "CUDA backend: on (${SHALLOW_SAND_NVCC}; compiled for ${listed}, newer GPUs translate when they first start)")
