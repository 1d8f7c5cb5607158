"""The mechanics of one axis for the judges: trapezoidal ramps in real time, in the units of the drive that uses it and seconds.

It knows no drive. `step` integrates to the given instant in pieces of half a millisecond, so a judge may call it as rarely as it likes.
"""
import math

PIECE_S = 0.0005


class Shaft:
    """`grain`: the smallest way that counts; a move ends when less is left and the speed is almost 0."""

    def __init__(self, place=0.0, grain=1.0):
        self.grain, self.position, self.velocity = grain, float(place), 0.0
        self.target = None            # a place; None: `speed` counts
        self.speed, self.up, self.down = 0.0, 1.0, 1.0
        self.now = None

    @property
    def rests(self):
        return self.velocity == 0.0 and (self.target is None or self.position == self.target) and (self.target is not None or self.speed == 0.0)

    def move(self, target, speed, up, down):
        self.target, self.speed, self.up, self.down = float(target), float(speed), float(up), float(down)

    def turn(self, speed, up, down):
        self.target, self.speed, self.up, self.down = None, float(speed), float(up), float(down)

    def brake(self, down):
        self.turn(0.0, down, down)

    def hold(self):
        """Stands at once."""
        self.target, self.speed, self.velocity = None, 0.0, 0.0

    def set(self, place):
        shift = place - self.position
        self.position = float(place)
        if self.target is not None:
            self.target += shift

    def step(self, now):
        if self.now is None or now - self.now > 5:
            self.now = now
        while self.now < now:
            seconds = min(PIECE_S, now - self.now)
            self.now = now if now - self.now <= PIECE_S else self.now + seconds
            self._piece(seconds)

    def _piece(self, seconds):
        wanted = self.speed
        if self.target is not None:
            way = self.target - self.position
            slow = 2 * max(self.down, self.up) * seconds
            if abs(self.velocity) <= slow and abs(way) <= max(self.grain, slow * seconds * 2):
                self.position, self.velocity = self.target, 0.0
                return
            wanted = math.copysign(min(self.speed, math.sqrt(2 * self.down * abs(way))), way)
        slower = abs(wanted) < abs(self.velocity) or wanted * self.velocity < 0
        most = (self.down if slower else self.up) * seconds
        # The root above is followed a piece late, so braking may be a little harder than the ramp.
        change = max(-most * (1.2 if slower else 1), min(most * (1.2 if slower else 1), wanted - self.velocity))
        self.velocity += change
        self.position += self.velocity * seconds
