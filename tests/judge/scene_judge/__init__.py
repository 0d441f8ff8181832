"""An independent judge of runs: it checks mechanics, laws, energy and repeatability from the result files of a run.

Nothing here calls the program's formulas or copies them. The motion of the bodies is taken from the columns of the trace.
Velocities of centres of mass, energies, Newton's and Euler's laws, and the laws of contact, friction, film and gas are written anew
from their definitions.
"""
