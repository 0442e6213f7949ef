# Third-party packages. Each folder links what it needs privately; no public header of ours shows their types, but for
# Eigen (poses) and the standard library.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Boost 1.74 REQUIRED)        # headers only: the yardstick of tests/bench/rt
find_package(tinyxml2 REQUIRED)
find_package(ZLIB REQUIRED)       # app/io: compressed records
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)  # ipc/record
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)    # ipc/record
find_package(EXPAT REQUIRED)      # scripts/programs/crcl
find_package(fastcdr REQUIRED)
find_package(fastrtps REQUIRED)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo-png)  # plots: app/plot
pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)  # rt_core/inverse_kinematics, as is LAPACK
find_package(LAPACK REQUIRED)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)      # rt_core/tissue
find_package(fcl REQUIRED)     # rt_core/collision
find_package(assimp REQUIRED)  # config/mesh_reader
# config/volume_reader. GDCM's own CMake files want its programs and Java wrappers too.
find_path(GDCM_INCLUDE_DIRS gdcmReader.h PATH_SUFFIXES gdcm-3.0 REQUIRED)
foreach(library gdcmCommon gdcmDICT gdcmDSED gdcmMSFF)
  find_library(${library}_LIBRARY ${library} REQUIRED)
endforeach()
pkg_check_modules(MOSQUITTO REQUIRED IMPORTED_TARGET libmosquitto)  # drivers/mqtt, as is protobuf (Sparkplug B)
find_package(Protobuf REQUIRED)
find_package(Qhull REQUIRED)   # rt_core/geometry: convex hulls
# drivers/display. Of OSMesa and EGL only the headers: the libraries are opened when a picture is wanted.
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(LIBPNG REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(OSMESA REQUIRED osmesa)
