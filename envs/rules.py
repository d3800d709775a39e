"""The numbers of the rules, each with its unit.

Lengths are in brick widths, times in ticks of 1/60 s. y points up, and the origin is the field's
lower left corner. Numbers that a user may change are in a record (`rulebook.Rules`), because Numba
freezes globals.
"""

# Raise this with every change after which a game may take another course: replays and snapshots of
# other versions are refused.
RULES_VERSION = 3

TICKS_PER_SECOND = 60

FIELD_WIDTH = 11.0
FIELD_HEIGHT = 14.0

COLUMNS = 11
ROWS = 18
CELLS = COLUMNS * ROWS
BRICK_WIDTH = 1.0
BRICK_HEIGHT = 0.5
LATTICE_TOP = FIELD_HEIGHT - 1.0
LATTICE_BOTTOM = LATTICE_TOP - ROWS * BRICK_HEIGHT

BALL_RADIUS = 0.125
BALL_SPEED = 0.176  # per tick, at speed stage 0
SPEED_STAGE_MIN = -1
SPEED_STAGE_MAX = 7
# Numbers of brick hits since the serve after which the speed stage rises by one.
SPEED_STAGE_HITS = (30, 55, 80, 105, 130, 150, 165)
MAX_BALLS = 3

PADDLE_WIDTH = 2.0
LONG_PADDLE_WIDTH = 3.0  # enlarged; never wider than the field, see `fit_paddle`
PADDLE_THICKNESS = 0.25
PADDLE_TOP = 2.0
PADDLE_Y = PADDLE_TOP - PADDLE_THICKNESS / 2
PADDLE_SPEED = 0.19  # per tick

SERVE_TICKS = 60  # after these the ball serves itself
SERVE_ANGLE_MIN = 20.0  # degrees from the vertical
SERVE_ANGLE_MAX = 40.0
DEFLECTION_MIN = 10.0  # degrees from the vertical, at the paddle's middle
DEFLECTION_RANGE = 53.0  # degrees more at the paddle's ends
CATCH_TICKS = 120  # after these a caught ball is released
FLAT_ANGLE = 10.0  # degrees from the horizontal: after a bounce a ball flies at least so steeply

# A ball that bounces so often without damage or paddle contact is turned by a random angle.
LOOP_BOUNCES = 64
LOOP_TURN_MIN = 10.0  # degrees
LOOP_TURN_MAX = 20.0

IDLE_TICKS = 3600  # without damage to a brick or the boss: they cost a life
# More hits of one ball in one tick than the fastest ball of the rules can make in a full field.
HITS_PER_TICK = 64

EXTRA_LIFE_FIRST = 20_000  # points; after it, every multiple of `EXTRA_LIFE_EVERY` gives a life
EXTRA_LIFE_EVERY = 60_000

# Kinds of bricks, in the order of their letters in a level file.
EMPTY = 0
COLOURS = 8  # kinds 1..8
SILVER = 9
GOLD = 10
BRICK_LETTERS = ".wocgrbmySX"
COLOUR_POINTS = (50, 60, 70, 80, 90, 100, 110, 120)
SILVER_POINTS = 50  # times the round's number
UNBREAKABLE = 255  # the hits left of a golden brick, always

# How the paddle deflects a ball.
ANGLE = 0
ZONES6 = 1
PHYSICAL = 2
DEFLECTIONS = {"angle": ANGLE, "zones6": ZONES6, "physical": PHYSICAL}
ZONE_ANGLES = (63.0, 40.0, 15.0, -15.0, -40.0, -63.0)

# What a decision pays.
PROGRESS = 0
SCORE = 1
SPARSE = 2
REWARDS = {"progress": PROGRESS, "score": SCORE, "sparse": SPARSE}

# Capsules, by their letters. The first three give powers; the player has one power at a time.
NO_CAPSULE = 0
CATCH = 1
ENLARGE = 2
LASER = 3
SLOW = 4
DISRUPT = 5
BREAK = 6
PLAYER = 7
CAPSULES = 7
CAPSULE_LETTERS = ".CELSDBP"
NO_POWER = 0
POWERS = 3
CAPSULE_RATE = 0.12  # of the coloured bricks
CAPSULE_SPEED = 1 / 16  # per tick, downward
CAPSULE_WIDTH = 0.8
CAPSULE_HEIGHT = 0.375
CAPSULE_POINTS = 1000
# The probability of break, and of player. The weights of the others share the rest.
RARE_WEIGHT = 3 / 256
DISRUPT_WEIGHT = 3 / 8
ENLARGE_WEIGHT = 2 / 8
SLOW_WEIGHT = 1 / 8
CATCH_WEIGHT = 1 / 8  # and laser: 1 / 8
SLOW_STAGES = 2
DISRUPT_ANGLE = 15.0  # degrees between the balls
BREAK_POINTS = 10_000

BEAM_TICKS = 15  # between shots
BEAM_SPEED = 0.5  # per tick, upward
BEAM_WIDTH = 0.125
BEAM_HEIGHT = 0.5
BEAM_PLACE = 0.6  # the two beams start so far from the paddle's middle, in half widths
# A shot is two beams, and flies for at most 24 ticks: there are at most two shots at once.
MAX_BEAMS = 4

MAX_ENEMIES = 3
ENEMY_KINDS = 4
ENEMY_POINTS = 100
ENEMY_TICKS_MIN = 240  # from one enemy to the next
ENEMY_TICKS_MAX = 600
GATES = 2
GATE_X = (2.75, 8.25)  # the middles of the gates in the ceiling
GATE_TICKS = 40  # a gate opens so long before an enemy comes
ENEMY_SPEED = 0.03  # per tick, drifting
CIRCLE_HEIGHT = 3.5  # an enemy drifts down to this y and then circles; all bricks are above
CIRCLE_SPEED = 0.05  # per tick
CIRCLE_RADIUS = 0.5
CIRCLE_TICKS = 126  # about two turns; then the enemy dives at the paddle
DIVE_SPEED = 0.1  # per tick
# An enemy stops so far from an obstacle. If it touched bricks, a rounding error would hold it at
# each seam between two bricks.
CLEARANCE = 1 / 1024

BOSS_X = 5.5
BOSS_Y = 10.0
BOSS_HITS = 16
BOSS_POINTS = 1000  # per hit
MAX_SHARDS = 4
SHARD_TICKS = 90  # from one shard to the next
SHARD_SPEED = 0.08  # per tick

# From round to round the difficulty of generated levels, in [0, 1], rises by this ...
DIFFICULTY_STEP = 0.05
# ... and begins here after the campaign.
DIFFICULTY_AFTER_CAMPAIGN = 0.5
