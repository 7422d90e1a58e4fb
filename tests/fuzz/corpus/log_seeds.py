# Writes the binary seeds of fuzz_logs: python3 log_seeds.py. The first byte chooses the reader, and
# with 8 has the checksums mended.
import pathlib
import struct

folder = pathlib.Path(__file__).parent / "logs"


def ubx(group, number, payload):
    body = struct.pack("<BBH", group, number, len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 255
        b = (b + a) & 255
    return b"\xb5\x62" + body + bytes([a, b])


def pvt(itow_s, second):
    return ubx(1, 7, struct.pack("<IHBBBBBBIiBBBB", itow_s * 1000, 2025, 8, 28, 11, 59, second, 7,
                                 20, 0, 3, 1, 0, 12)
               + struct.pack("<iiiiIIiiiiiII", -82500000, 475000000, 448500, 400000, 2000, 3000,
                             1000, -2000, 500, 2236, 0, 300, 0) + bytes(20))


def precise(itow_s):
    return ubx(1, 20, struct.pack("<IIiiiibbbbII", 0, itow_s * 1000, -82500000, 475000000, 448500,
                                  400000, 1, 2, 3, 4, 200, 300))


def meas(tag_ms, types):
    words = [kind << 24 | (1000 + kind) for kind in types]
    return ubx(16, 2, struct.pack("<IHH", tag_ms, len(words) << 11 | 8, 0)
               + struct.pack("<%dI" % len(words), *words) + struct.pack("<I", tag_ms))


def raw(count):
    blocks = b"".join(struct.pack("<II", kind << 24 | 77, count + 256 * k)
                      for k in range(3) for kind in (14, 13, 5, 12, 16, 17, 18))
    return ubx(16, 3, bytes(4) + blocks)


def ulog(kind, content):
    return struct.pack("<H", len(content)) + kind + content


noon = 4 * 86400 + 43200
fixes = b"".join(pvt(noon + k, 42 + k) + precise(noon + k) for k in range(3))
sensors = b"".join(meas(1000 * k + 5, (14, 13, 5)) + meas(1000 * k, (16, 17, 18)) + raw(25600 * k)
                   + pvt(noon + k, 42 + k) for k in range(3))
head = b"ULog\x01\x12\x35\x01" + bytes(8)
flight = head + ulog(b"B", bytes(40))
flight += ulog(b"F", b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;"
               b"float[3] accelerometer_m_s2;")
flight += ulog(b"F", b"sensor_gps:uint64_t timestamp;double latitude_deg;double longitude_deg;"
               b"double altitude_ellipsoid_m;float s_variance_m_s;float eph;float epv;"
               b"float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;"
               b"bool vel_ned_valid;")
flight += ulog(b"A", b"\0\x01\0sensor_combined") + ulog(b"A", b"\0\x02\0sensor_gps")
for k in range(3):
    flight += ulog(b"D", struct.pack("<HQ6f", 1, 1000000 + 5000 * k, 0.1, 0.2, 0.3, 1, 2, -9.8))
    flight += ulog(b"D", struct.pack("<HQ3d6fBB", 2, 1000000 + 200000 * k, 47.5, -8.25, 448.5, 0.3,
                                     2, 3, 1, 2, 0.5, 3, 1))
flight += ulog(b"S", b"\x2f\x73\x13\x20\x25\x0c\xbb\x12") + ulog(b"L", b"6" + bytes(8) + b"end")

header = b"time,seconds_elapsed,z,y,x\n"
rows = b"".join(b"%d,%d,9.8,0.1,0.2\n" % (1700000000000000000 + k * 10**7, k) for k in range(12))
location = (b"time,bearingAccuracy,speedAccuracy,verticalAccuracy,horizontalAccuracy,speed,bearing,"
            b"altitude,longitude,latitude,seconds_elapsed\n"
            b"1700000000000000000,2,0.5,3,4,10,90,448.5,-8.25,47.5,0\n"
            b"1700000001000000000,2,0.5,3,4,10,90,448.5,-8.25,47.5,1\n")

seeds = {"phone_folder": b"\x10" + header + rows + b"\1\n" + header + rows,
         "phone_location": b"\1" + location,
         "ubx_fixes": b"\x09" + fixes, "ubx_sensors": b"\x08" + sensors, "ulog_imu": b"\0" + flight,
         "ulog_fixes": b"\1" + flight}
for name, content in seeds.items():
    (folder / name).write_bytes(content)
