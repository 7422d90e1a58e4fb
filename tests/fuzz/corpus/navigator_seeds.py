"""Writes the first seeds of fuzz_navigator: short drives, as the bytes it decodes."""
from pathlib import Path

OUT = Path(__file__).parent / "navigator"

IMU = bytes([99, 0])  # 36 good increments
EXACT = bytes([0, 128])  # a number close to its middle
FIX = bytes([150, 0, 200, 0]) + 3 * EXACT + bytes([0]) + 3 * EXACT + bytes([0])
SAMPLE = bytes([130, 0]) + 6 * EXACT
ODOMETER = bytes([205, 0, 128]) + 2 * EXACT
BAROMETER = bytes([220, 0, 128]) + 2 * EXACT
HEADING = bytes([226, 0, 128]) + 2 * EXACT
START = bytes([232, 4])
START_OPEN = bytes([232, 255])
RESTORE = bytes([240, 0])
DAMAGED = bytes([240, 255, 1, 2])
COPY = bytes([250])
NAN_FIX = bytes([150, 0, 200, 0, 240]) + 2 * EXACT + bytes([0]) + 3 * EXACT + bytes([0])
HOLE = bytes([5, 255, 200, 250]) + 7 * EXACT
JUMP = 6 * (bytes([5, 255, 255]) + 7 * EXACT)


def drive(parts, *operations):
    return bytes([parts]) + b"".join(operations)


SEEDS = {
    "plain": drive(0, START, 8 * (IMU + FIX), RESTORE, IMU, COPY, FIX, IMU),
    "align": drive(0, 12 * (IMU + FIX)),
    "heading": drive(0, 12 * (HEADING + IMU + FIX)),
    "car": drive(1, START_OPEN, 6 * (IMU + FIX + ODOMETER + BAROMETER), DAMAGED, IMU),
    "mount": drive(2 + 16, 10 * (IMU + FIX), RESTORE, IMU),
    "lags": drive(4 + 64, START, 6 * (IMU + FIX), NAN_FIX, IMU, FIX),
    "samples": drive(0, START, 10 * SAMPLE, FIX, 10 * SAMPLE),
    "hole": drive(8, START, IMU + FIX, HOLE, HOLE, IMU, FIX, IMU),
    "jump": drive(32, START, IMU + FIX, JUMP, 4 * (IMU + FIX)),
}

if __name__ == "__main__":
    OUT.mkdir(exist_ok=True)
    for name, content in SEEDS.items():
        (OUT / name).write_bytes(content)
