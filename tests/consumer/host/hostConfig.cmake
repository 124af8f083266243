include(CMakeFindDependencyMacro)
find_dependency(massspring)
include(${CMAKE_CURRENT_LIST_DIR}/hostTargets.cmake)
