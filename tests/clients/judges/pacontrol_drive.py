"""A PA-CONTROL on its serial port COM1, written from the maker's manual of the interfaces alone, on a pseudo-terminal or TCP.

    pacontrol_drive.py [--axes N] [the switches of line.py] [--state-late-ms N] [--axis-late-ms N] [--position-ms N] [--check text|etx]
                       [--zero-reply] [--no-stop-multi] [--silent-poll] [--power-ms N] [--ep] [--enable-mode N]

It shares no code with the gateway or its twins. The switches are the choices that the manual leaves to a control. It knows the operating modes home
position and ONLINE, the elements, axis and system parameters, the moves 0A87 to 0A95, and the reference run. Prints one line for each change of the
operating status and each start of an axis.
"""
from line import DriveLine, arguments
from shaft import Shaft

parser = arguments(__doc__)
parser.add_argument("--axes", type=int, default=2)
parser.add_argument("--state-late-ms", type=float, default=0, help="STATUS of an acknowledgement is that of so long ago")
parser.add_argument("--axis-late-ms", type=float, default=0, help="1910, 1911 and 1921 show an axis as it was so long ago")
parser.add_argument("--position-ms", type=float, default=0, help="positions are renewed so often")
parser.add_argument("--check", choices=("text", "etx"), default="text", help="the sum of a request: over its text, or with ETX as in replies")
parser.add_argument("--zero-reply", action="store_true", help="the check of replies is 0")
parser.add_argument("--no-stop-multi", action="store_true", help="0A9A is unknown: it is missing in the overview of chapter 5.1")
parser.add_argument("--silent-poll", action="store_true", help="EOT without a command in progress is not answered")
parser.add_argument("--power-ms", type=float, default=0, help="an axis is ready so long behind 0A97")
parser.add_argument("--ep", action="store_true", help="speed may change while an axis moves; 1915 and 1920 are there")
parser.add_argument("--enable-mode", type=float, default=0, help="axis parameter 32h")
args = parser.parse_args()

SOH, STX, ETX, EOT = 1, 2, 3, 4
# Axis parameters by number: what a control has been set to.
PARAMETERS = {0x01: 200.0, 0x02: 100.0, 0x03: 50.0, 0x04: 10.0, 0x05: 1.0, 0x06: 500.0, 0x07: 5.0, 0x08: -500.0, 0x09: 1000.0, 0x32: args.enable_mode}
SYSTEM = {0x01: 1, 0x02: args.axes, 0x03: 1, 0x04: 2, 0x05: 3, 0x06: 1, 0x07: 2, 0x14: 0}


def xor(data):
    value = 0
    for b in data:
        value ^= b
    return value


def real(number):
    """Seven significant digits with trailing zeros, as the manual prints them."""
    whole = len(str(int(abs(number))))
    return f"{number:.{max(0, 7 - whole)}f}"


class Refused(Exception):
    pass


class Late:
    """A value as it was some time ago."""

    def __init__(self, seconds, value):
        self.seconds, self.past = seconds, [(0.0, value)]

    def note(self, value, now):
        if self.past[-1][1] != value:
            self.past.append((now, value))
        while len(self.past) > 1 and self.past[1][0] <= now - self.seconds:
            self.past.pop(0)

    @property
    def value(self):
        return self.past[0][1]


class Axis:
    def __init__(self, number):
        self.number, self.shaft, self.parameters = number, Shaft(7.5, grain=0.001), dict(PARAMETERS)
        self.referenced, self.on, self.ready_at, self.stopped, self.reference_due = False, args.enable_mode == 1, 0.0, False, None
        self.speed = self.ramp = None
        self.offset, self.shown, self.renewed = 0.0, 7.5, 0.0
        self.status = Late(args.axis_late_ms / 1000, 0)

    def step(self, now):
        self.shaft.step(now)
        if self.reference_due and self.shaft.rests:
            self.shaft.set(0.0)
            self.shaft.hold()
            self.referenced, self.reference_due = True, None
        self.status.note(1 if self.moving else 2 if self.stopped else 0, now)
        if now - self.renewed >= args.position_ms / 1000:
            self.shown, self.renewed = self.shaft.position, now

    @property
    def moving(self):
        return not self.shaft.rests

    def start(self, target, now):
        if not self.referenced:
            raise Refused(0x2B)
        if not self.on or now < self.ready_at:
            raise Refused(0x37)
        if self.moving:
            raise Refused(0x2A)
        if not self.parameters[0x08] + self.offset <= target <= self.parameters[0x09] + self.offset:
            raise Refused(0x41)
        self.stopped = False
        ramp = self.ramp or self.parameters[0x06]
        print("axis", self.number, "to", round(target, 4), flush=True)
        self.shaft.move(target, self.speed or self.parameters[0x01], ramp, ramp)

    def stop(self):
        if self.moving:
            self.shaft.brake(self.ramp or self.parameters[0x06])
            self.stopped = True


class Control:
    def __init__(self, line):
        self.line, self.axes, self.buffer, self.status = line, [Axis(n + 1) for n in range(args.axes)], b"", 1
        self.shown = Late(args.state_late_ms / 1000, 1)
        self.running, self.elements = None, {k: {} for k in "IOMNR"}

    def enter(self, status):
        if status != self.status:
            print("status", status, flush=True)
            self.status = status

    def step(self, now):
        for axis in self.axes:
            axis.step(now)
        if self.status == 32 and not any(a.moving for a in self.axes):
            self.enter(35)
        self.shown.note(self.status, now)

    # --- frames

    def heard(self, data, now):
        for byte in data:
            if byte == SOH and STX not in self.buffer[-1:]:
                self.buffer = b"\x01"
            elif not self.buffer and byte == EOT:
                self.poll(now)
            elif byte == EOT:
                frame, self.buffer = self.buffer, b""
                self.frame(frame, now)
            elif self.buffer:
                self.buffer += bytes([byte])

    def reply(self, quit_, done, kind, data):
        text = f"{quit_};{int(done)};{self.shown.value};0;{kind};{data}".encode()
        check = 0 if args.zero_reply else xor(text) ^ ETX
        self.line.say(b"\x01\x02" + text + b"\x03" + str(check).encode() + b"\x04")

    def frame(self, frame, now):
        if frame[:2] != b"\x01\x02" or frame.count(b"\x03") != 1:
            return self.reply(18 if frame[:2] != b"\x01\x02" else 17, True, 0, 0)
        text, check = frame[2:].split(b"\x03")
        wanted = xor(text) ^ (ETX if args.check == "etx" else 0)
        if check != b"0" and check != str(wanted).encode():
            return self.reply(16, True, 0, 0)
        fields = text.decode("latin-1").split(";")
        try:
            code, parameter, kind, data = int(fields[0], 16), int(fields[1]), fields[2], float(fields[3])
        except (ValueError, IndexError):
            return self.reply(17, True, 0, 0)
        self.running = None
        try:
            kind, value, running = self.command(code, parameter, data, now)
        except Refused as refused:
            return self.reply(refused.args[0], True, 0, 0)
        self.step(now)
        self.running = running
        return self.reply(0, running is None or running[0](), kind, value)

    def poll(self, now):
        if self.running is None:
            if not args.silent_poll:
                self.reply(0, True, 0, 0)
            return
        ended, shows = self.running
        over = ended()
        if over:
            self.running = None
        self.reply(0, over, 1, real(shows()))

    # --- commands: (type, acknowledge data, nothing or (whether it has ended, what a poll shows))

    def axis(self, number):
        if not 1 <= number <= len(self.axes):
            raise Refused(0x20)
        return self.axes[number - 1]

    def command(self, code, parameter, data, now):
        if code in (0x0600, 0x0602, 0x0603):
            return self.mode(code)
        if code in (0x0700, 0x1700, 0x1701, 0x1702):
            return self.system(code, parameter, data)
        if code in (0x0800, 0x1800, 0x1801, 0x1802):
            return self.parameter(code, parameter, data)
        if code >> 8 in (0x09, 0x19):
            return self.element(code, parameter, data, now)
        if code >> 8 == 0x0A:
            return self.online(code, parameter, data, now)
        raise Refused(0x13)

    def mode(self, code):
        if code == 0x0603:
            if self.status != 1:
                raise Refused(0x14)
            for axis in self.axes:
                axis.speed = axis.ramp = None
            self.enter(31)
        elif code == 0x0600 and self.status in (31, 32, 35):
            for axis in self.axes:
                axis.stop()
            self.enter(32 if any(a.moving for a in self.axes) else 35)
        else:
            raise Refused(0x14)
        return 0, 0, None

    def system(self, code, number, data):
        if self.status != 1:
            raise Refused(0x14)
        if number not in SYSTEM:
            raise Refused(0x22)
        if code == 0x0700:
            SYSTEM[number] = int(data)
        return 0, {0x1701: 16, 0x1702: 0}.get(code, SYSTEM[number]), None

    def parameter(self, code, number, data):
        if self.status != 1:
            raise Refused(0x14)
        axis, n = self.axis(number >> 8), number & 0xFF
        if not 1 <= n <= 0x32:
            raise Refused(0x21)
        if code == 0x0800:
            axis.parameters[n] = data
        limits = {0x1801: 1e6, 0x1802: -1e6 if n in (8, 9) else 0.0}
        return 1, real(limits.get(code, axis.parameters.get(n, 0.0))), None

    def element(self, code, n, data, now):
        low = code & 0xFF
        if low in (0x00, 0x02, 0x04, 0x06, 0x07):
            store = self.elements[{0: "I", 2: "O", 4: "M", 6: "N", 7: "R"}[low]]
            if not 1 <= n <= 1024:
                raise Refused({0: 0x23, 2: 0x24, 4: 0x25, 6: 0x26, 7: 0x27}[low])
            if code >> 8 == 0x09:
                store[n] = data
            value = store.get(n, 0)
            return (1, real(value), None) if low == 7 else (0, int(value), None)
        if low in (0x01, 0x03, 0x05):
            return 0, 0, None
        if low == 0x09:
            if code == 0x0909 and self.status not in (1, 9):
                raise Refused(0x14)
            return 0, 0, None
        if low == 0x0B:
            return 0, self.shown.value, None
        if low == 0x11:
            return 0, sum((a.status.value == 1) << a.number - 1 for a in self.axes), None
        if low in (0x34, 0x35, 0x37):
            return self.system_element(low, n)
        return self.of_axis(low, self.axis(n), now)

    def system_element(self, low, n):
        if low == 0x34:
            referenced = 51 <= n < 51 + len(self.axes) and self.axes[n - 51].referenced
            moving = 91 <= n < 91 + len(self.axes) and self.axes[n - 91].status.value == 1
            return 0, int(referenced or moving), None
        if low == 0x35:
            return 0, self.axes[n - 71].status.value if 71 <= n < 71 + len(self.axes) else 0, None
        return 1, real(0.0), None

    def of_axis(self, low, axis, now):
        if low == 0x0C:
            return 1, real(axis.shown), None
        if low == 0x0D:
            return 1, real(abs(axis.shaft.velocity)), None
        if low == 0x10:
            return 0, axis.status.value, None
        if low in (0x13, 0x14):
            return 1, real(axis.parameters[8 if low == 0x13 else 9] + axis.offset), None
        if low == 0x21:
            # Byte 0 is the highest: power pack, positive and negative limit switch (1: free), status; 0100 0104h is the printed example.
            return 0, (axis.on and now >= axis.ready_at) << 24 | 1 << 16 | 1 << 8 | axis.status.value, None
        if low == 0x15 and args.ep:
            return 0, 0, None
        if low == 0x20 and args.ep:
            return 0, 31, None
        raise Refused(0x13)

    def online(self, code, n, data, now):
        low = code & 0xFF
        if low == 0x41 or self.status not in (31, 32, 35):
            raise Refused(0x14)
        if low == 0x81:
            for axis in self.axes:
                axis.shaft.hold()
                axis.on = axis.parameters[0x32] == 1
            self.enter(1)
            return 0, 0, None
        if low == 0xA2:
            return 0, 0, None
        axis = self.axis(n)
        if low in (0x87, 0x89, 0x90, 0x91, 0x94, 0x95):
            return self.start(low, axis, data, now)
        if low in (0x93, 0x9A):
            if low == 0x9A and args.no_stop_multi:
                raise Refused(0x13)
            axis.stop()
            return 1, real(axis.shaft.position), (lambda: not axis.moving, lambda: axis.shaft.position) if low == 0x93 else None
        if low in (0x97, 0x98):
            axis.on = low == 0x97
            axis.ready_at = now + args.power_ms / 1000
            if not axis.on:
                axis.shaft.hold()
            return 0, 0, None
        if low in (0x8D, 0x8E):
            if axis.moving and not (args.ep and low == 0x8D):
                raise Refused(0x2A)
            if data <= 0 or low == 0x8D and data > 10 * axis.parameters[1]:
                raise Refused(0x29)
            axis.speed, axis.ramp = (data, axis.ramp) if low == 0x8D else (axis.speed, data)
            return 1, real(data), None
        return self.reference(low, axis, data, now)

    def start(self, low, axis, data, now):
        if self.status != 31:
            raise Refused(0x14)
        begin = axis.shaft.position
        axis.start(begin + data if low in (0x89, 0x91, 0x95) else data, now)
        return 1, real(begin), (lambda: not axis.moving, lambda: axis.shown) if low in (0x87, 0x89) else None

    def reference(self, low, axis, data, now):
        if low in (0x84, 0x85, 0x86, 0x96) and axis.moving:
            raise Refused(0x2A)
        if low == 0x83:
            axis.referenced = True
        elif low == 0x84:
            if not axis.on:
                raise Refused(0x37)
            axis.reference_due, axis.referenced = now, False
            axis.shaft.move(0.0, axis.parameters[2], axis.parameters[6], axis.parameters[6])
            return 0, 0, (lambda: axis.reference_due is None, lambda: axis.shown)
        elif low == 0x85:
            axis.shaft.set(0.0)
        elif low == 0x86:
            axis.offset += data - axis.shaft.position
            axis.shaft.set(data)
            return 1, real(data), None
        elif low == 0x96:
            axis.shaft.set(data)
            axis.referenced = True
            return 1, real(data), None
        else:
            raise Refused(0x13)
        return 0, 0, None


line = DriveLine(args, noise=b"")
control = Control(line)
line.serve(control.heard, control.step)
