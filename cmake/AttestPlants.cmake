# The simulators of harness/plant: attest_mujoco and SUNDIALS::arkode, SUNDIALS::nvecserial.

# Not MuJoCo's own CMake config: it requires OpenGL and qhull, which only its viewer and its
# compilation need.
find_path(ATTEST_MUJOCO_INCLUDE mujoco/mujoco.h DOC "Folder that has mujoco/mujoco.h")
find_library(ATTEST_MUJOCO_LIBRARY mujoco DOC "libmujoco 2.2 or later")
mark_as_advanced(ATTEST_MUJOCO_INCLUDE ATTEST_MUJOCO_LIBRARY)
if(NOT ATTEST_MUJOCO_INCLUDE OR NOT ATTEST_MUJOCO_LIBRARY)
  message(FATAL_ERROR "MuJoCo is missing: install libmujoco-dev, or run ci/bootstrap")
endif()
add_library(attest_mujoco UNKNOWN IMPORTED)
set_target_properties(
  attest_mujoco PROPERTIES IMPORTED_LOCATION "${ATTEST_MUJOCO_LIBRARY}"
                           INTERFACE_INCLUDE_DIRECTORIES "${ATTEST_MUJOCO_INCLUDE}")

# With clang this looks for OpenMP too: libomp-dev.
find_package(SUNDIALS 6.4 REQUIRED CONFIG COMPONENTS arkode nvecserial)
