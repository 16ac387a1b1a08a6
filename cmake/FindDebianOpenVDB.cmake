# OpenVDB comes with a find module, which Debian keeps where CMake does not look; the module prints notes of no use to
# anybody. Included by the project itself and by its installed package.
set(fascicle_module_path "${CMAKE_MODULE_PATH}")
set(fascicle_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
set(OPENVDB_USE_DELAYED_LOADING OFF)
find_package(OpenVDB REQUIRED COMPONENTS openvdb)
set(CMAKE_MODULE_PATH "${fascicle_module_path}")
set(CMAKE_MESSAGE_LOG_LEVEL "${fascicle_log_level}")
