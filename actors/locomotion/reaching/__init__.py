"""Reaching: inverse kinematics of a limb and the trunk it hangs on."""
