"""An independent judge of runs: mechanics, laws, energy and repeatability from the files that a run leaves behind.

Nothing here calls the program's formulas or copies them. The bodies' motion is taken from the columns of the trace; velocities of
centres of mass, energies, Newton's and Euler's laws, contact, friction, film and gas laws are written here again from their definitions.
"""
