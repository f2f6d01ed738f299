# SPDX-License-Identifier: BSD-3-Clause
"""Parameters by their name in PX4. All are numbers of binary32, the integer ones too."""

from binary32 import Binary32

PX4_V114 = "px4-v1.14.4"
PX4_V115 = "px4-v1.15.4"
PX4_V116 = "px4-v1.16.0"
PX4_V117 = "px4-v1.17"
PX4_V118 = "px4-v1.18"
SINCE_V117 = (PX4_V118, PX4_V117)
SINCE_V116 = (*SINCE_V117, PX4_V116)
PROFILES = (*SINCE_V116, PX4_V115, PX4_V114)

AXES = ("ROLL", "PITCH", "YAW")


class Parameters:
    """`set` stores a value. The unit reads all values at its first step and at parameter_update."""

    def __init__(self, defaults):
        self._stored = {name: Binary32(value) for name, value in defaults.items()}
        self._is_read = False

    def set(self, name, value):
        """Returns False if the profile has no such parameter."""
        if name not in self._stored:
            return False
        self._stored[name] = Binary32(value)
        return True

    def newly_read(self, is_updated):
        """The values by name, at the first step and at each update of the parameters, else None."""
        if self._is_read and not is_updated:
            return None
        self._is_read = True
        return dict(self._stored)
