"""Every tolerance of the engine, with its unit and its reason."""

# Radians. Two directions closer than this count as parallel. Rotating a polygon leaves errors of
# about 1e-16 in its normals; two strips that are meant to be parallel must not become inseparable
# for that. Over a length L it hides a gap of L * 1e-12.
PARALLEL = 1e-12

# (length / time)^2. A relative velocity whose square is smaller counts as 0, because the squares of
# such small numbers lose digits to underflow. It is a speed of 1e-145.
NO_SPEED_SQUARED = 1e-290

# A fraction of the polygon's size (or of the farthest half-plane's distance from the origin). An
# edge shorter than this is a corner: rounding alone can make or unmake it.
NO_LENGTH = 1e-12

# A fraction of the coordinates of two bodies and of their sizes, along an axis: 4096 roundings of
# these numbers. Up to this gap, and up to this overlap, the two touch. Finding the gap takes about
# 16 roundings, and each step in which a body slides down a slope adds one. A body that is deeper
# was put there, and is relaxed.
TOUCH = 2.0**-41

# A fraction of the speeds that two bodies have had since their plans were made, |vx| + |vy|. Bodies
# that approach more slowly only seem to, by the rounding of the hits before: each leaves an error
# of a few last digits, 1e-16, of what the speeds were. If they touch, they rest.
NO_APPROACH = 1e-14

# A fraction of the change of a velocity by the hit of two bodies: seven roundings of 1.1e-16, and
# some. A velocity that is smaller after the hit is 0.
NO_TURN = 1e-15

# Rounds of relaxation at the beginning of a step. In a pile where each body pushes the next one,
# each round reduces the overlaps by a constant factor; where there is no room, this limit ends it.
RELAX_ROUNDS = 64

# Of so many of these rounds, the last one moves all pairs apart together. Most overlaps need fewer.
RELAX_PAIRWISE = 16

# It minds gaps up to so many times the deepest overlap: so far a light body may have to move.
RELAX_REACH = 8.0

# A fraction of a body's speed. Which of two static bodies it meets first is a matter of rounding if
# it touches both; they are compared if it approaches them at least this fast.
FLATTEST = 1e-9

# Lengths and speeds. The engine multiplies up to two of them, and the squares of larger ones are no
# numbers.
FARTHEST = 1e140

# A fraction of a group's speeds, and of the changes of them. A group is resolved when no touch
# lacks more; the hits that would follow are slower than NO_APPROACH.
RESOLVED = 4e-15

# The same, while bodies still join the group.
ROUGHLY = 0.01

# Steps of the method that resolves a group: some, and some for each touch. It needs about one for
# each touch; rounding costs a few more.
STEPS = 64
STEPS_PER_TOUCH = 8

# A small group may take more steps: all its touches together so many, which cost a millisecond. The
# method begins again when a touch loses its impulse, or gets one, and where light bodies bear heavy
# ones it then has a long way to go: ten touches, with masses of 1 : 10 000, took 1400 steps.
STEPS_OF_ALL = 40_000

# The same while overlaps are relaxed. Where there is no room, this ends it, and what is left is
# relaxed pair by pair.
RELAX_STEPS = 1

# A fraction. If a course, in the method that resolves a group, bends less than this, there is no
# end to it: the bodies have no room. Masses of 1 : 1e9 still bend by 1e-10. Bodies that press each
# other along a line that is straight to 1e-6 would leave it a million times faster.
NO_BEND = 1e-12

# Where bodies have no room, each touch gets what it lacks so often. There is no right answer.
SWEEPS = 8

# A fraction of a body's size. If neither body has gone farther since it was moved last, their hit
# goes nowhere: where there is no room, or less and less, hits follow each other without end.
NO_WAY = 1e-4

# Hits of a body in a row that go nowhere. If it loses speed each time, there is no end to them, in
# a finite time: they are a geometric series. After so many its limit is taken: all that is left of
# the speed is lost at once.
LONGEST_SERIES = 32

# Such a hit counts for so many. So squeezed bodies cost a millisecond and not ten, while two blocks
# may hit each other ten thousand times at distances that one can see.
HITS_FOR_NOTHING = 10

# How often a body comes to rest before it slides: while bodies that rest on each other slide, the
# directions may turn, so that they hit each other again, always sooner.
MOST_RESTS = 8

# What slides rests on what it approaches with no more than this fraction of the speeds, as for
# NO_APPROACH. It looks again when it has gone this fraction of its size: so far it may sink in.
SLIDE = 0.01
