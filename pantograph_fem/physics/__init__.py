"""The mechanics: kinematics of fibres, energy densities, rigid motions of grips."""
