#!/usr/bin/env bash
# Writes two minutes of a car's drive in the forms that the tools of recorders write, so that the
# recipes of docs/guide/log-recipes.md can be tried. usage: samples.sh FOLDER
set -euo pipefail
out=$1
leeway simulate --trajectory car --duration-s 120 --imu-rate-hz 50 --imu-class tactical \
  --gnss-correlated-sigma-m 0 --out "$out/drive" > "$out.log"
imu=$out/drive/imu.csv gnss=$out/drive/gnss.csv

# ROS 1, `rostopic echo -b BAG -p TOPIC`: forward, left, up; ns since 1970.
ros_time='function stamp(t) { return sprintf("%d%09d", 1700000000 + int(t), (t - int(t)) * 1e9 + 0.5) }'
awk -F, "$ros_time"'
  BEGIN { print "%time,field.header.seq,field.header.stamp,field.header.frame_id," \
    "field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z," \
    "field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z" }
  NR > 1 { t = stamp($1); printf "%s,%d,%s,imu,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n", t, NR, t,
    $3 / $2, -$4 / $2, -$5 / $2, $6 / $2, -$7 / $2, -$8 / $2 }' "$imu" > "$out/ros-imu.txt"
awk -F, "$ros_time"'
  BEGIN { print "%time,field.header.seq,field.header.stamp,field.header.frame_id," \
    "field.status.status,field.status.service,field.latitude,field.longitude,field.altitude" }
  NR > 1 { t = stamp($1); printf "%s,%d,%s,gps,0,1,%.11f,%.11f,%.5f\n", t, NR, t, $2, $3, $4 }' \
  "$gnss" > "$out/ros-gnss.txt"

# MCAP, `mcap cat --json` through jq.
tail -n +2 "$out/ros-imu.txt" | awk -F, '
  BEGIN { print "stamp,angular_velocity.x,angular_velocity.y,angular_velocity.z," \
    "linear_acceleration.x,linear_acceleration.y,linear_acceleration.z" }
  { printf "%.9f,%s,%s,%s,%s,%s,%s\n", $1 / 1e9, $5, $6, $7, $8, $9, $10 }' > "$out/mcap-imu.csv"
tail -n +2 "$out/ros-gnss.txt" | awk -F, '
  BEGIN { print "stamp,latitude,longitude,altitude" }
  { printf "%.9f,%s,%s,%s\n", $1 / 1e9, $7, $8, $9 }' > "$out/mcap-gnss.csv"

# KITTI, a folder of oxts at 10 Hz: a file for each time, forward, left, up.
mkdir -p "$out/oxts/data"
awk -F, -v out="$out/oxts" '
  NR == FNR { if (FNR > 1) place[int(10 * $1 + 0.5)] = $2 " " $3 " " $4; next }
  FNR == 1 { next }
  { for (j = 3; j <= 8; ++j) sum[j] += $j
    dt += $2
    if (++n % 5) next
    file = sprintf("%s/data/%010d.txt", out, ++frame)
    wx = sum[3] / dt; wy = -sum[4] / dt; wz = -sum[5] / dt
    ax = sum[6] / dt; ay = -sum[7] / dt; az = -sum[8] / dt
    print place[n / 5], 0, 0, 0, 0, 0, 0, 0, 0, ax, ay, az, ax, ay, az, wx, wy, wz, wx, wy, wz, 0.1, 0.1, \
      4, 11, 6, 6, 6 > file
    close(file)
    printf "2011-09-26 13:%02d:%012.9f\n", int($1 / 60), $1 % 60 > (out "/timestamps.txt")
    dt = 0
    split("", sum) }' "$out/drive/truth.csv" "$imu"

# NovAtel, ASCII of RAWIMUSX and BESTPOS: right, forward, up, as counts of an ADIS16488.
awk -F, -v week=2381 -v gyro=5.85168e-9 -v accel=9.31323e-8 '
  FNR == 1 { ++file; next }
  { sow = 345600 + $1 }
  file == 1 { printf "#BESTPOSA,COM1,0,60.0,FINESTEERING,%d,%.3f,02000000,b1f6,16248;" \
    "SOL_COMPUTED,NARROW_INT,%.11f,%.11f,%.4f,-40.0000,WGS84,%.4f,%.4f,%.4f,\"\",0.0,0.0,12,12,12," \
    "11,0,06,33,33*00000000\n", week, sow, $2, $3, $4 + 40, $8, $9, $10 }
  file == 2 { printf "%%RAWIMUSXA,%d,%.3f;00,41,%d,%.9f,00004c37,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f" \
    "*00000000\n", week, sow, week, sow, -$8 / accel, -$6 / accel, $7 / accel, -$5 / gyro,
    -$3 / gyro, $4 / gyro }' "$gnss" "$imu" > "$out/novatel.txt"
