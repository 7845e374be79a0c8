# Language level, warnings, sanitizers, compiler cache.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers need the sloppiness flags, or every file is a miss.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

# Options structs leave members to their defaults on purpose.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options(-fpch-preprocess)
endif()
# No silent fused multiply-adds: AVX2 and AVX-512 walks must agree bit for bit.
add_compile_options(-ffp-contract=off)
if(SEARCHLIGHT_WERROR)
  add_compile_options(-Werror)
endif()
if(SEARCHLIGHT_SANITIZE)
  add_compile_options(-fsanitize=${SEARCHLIGHT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SEARCHLIGHT_SANITIZE})
endif()

find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)

# Vector code is compiled once for each instruction set that Highway knows, but for SSSE3: no machine of the last fifteen
# years prefers it. Under sanitizers, where one set takes minutes a file, AVX2 and the fallback without SIMD are enough,
# and the checks of each address, which AddressSanitizer makes anyway, are left out: they cost five times as long again.
# Highway withholds that fallback, 4 emulated lanes, from GCC before 12.3 for a fault in 16-bit products: there are none.
find_library(HWY_LIBRARY hwy REQUIRED)
add_library(searchlight_vectors INTERFACE)
target_link_libraries(searchlight_vectors INTERFACE ${HWY_LIBRARY})
set(disabled HWY_SSSE3)
if(SEARCHLIGHT_SANITIZE)
  set(disabled "(HWY_SSSE3|HWY_SSE4|HWY_AVX3)")
  target_compile_options(searchlight_vectors INTERFACE -fno-sanitize=null,alignment,object-size,pointer-overflow,vptr)
endif()
target_compile_definitions(searchlight_vectors INTERFACE HWY_DISABLED_TARGETS=${disabled} HWY_BROKEN_EMU128=0)
