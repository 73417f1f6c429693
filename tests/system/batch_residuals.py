#!/usr/bin/env python3
"""batch_residuals.py ARCHIVE MISSION: recomputes what each edge said to the estimator `batch` from the axis, the rate and
the drift that the archive has, and prints the largest difference from the archive's residuals in seconds.

It shares no code with spindrift: slits and beams are those of edge_prediction.h, the horizon is a sphere, the Sun
is ERFA's. The phase of the body, which the archive does not have, is the one that fits the residuals best.
"""
import datetime
import math
import pathlib
import sqlite3
import sys
import tomllib

import erfa

EARTH_KM = 6378.137
AU_KM = 149597870.7
LIGHT_KM_S = 299792.458
DAY_S = 86400.0
TAI_OF_1970_JD = 2440587.5


def read_orbit(path):
    """Times, TAI s, and positions, km. The passes are of when TAI was 37 s ahead of UTC."""
    states = []
    for line in path.read_text().splitlines():
        fields = line.split()
        if len(fields) == 7:
            utc = datetime.datetime.fromisoformat(fields[0]).replace(tzinfo=datetime.timezone.utc)
            states.append((utc.timestamp() + 37.0, [float(field) for field in fields[1:4]], [float(field) for field in fields[4:]]))
    return states


def state_at(states, t):
    """Position by Lagrange's polynomial through eight states, velocity by its two neighbours."""
    first = max(0, min(sum(state[0] <= t for state in states) - 4, len(states) - 8))
    some = states[first:first + 8]
    position = [0.0, 0.0, 0.0]
    for i, (t_i, at_i, _) in enumerate(some):
        weight = math.prod((t - t_j) / (t_i - t_j) for j, (t_j, _, _) in enumerate(some) if j != i)
        position = [p + weight * a for p, a in zip(position, at_i)]
    return position


def sun_from(position, t):
    """Apparent direction of the Sun, as the spacecraft sees it."""
    heliocentric, barycentric = erfa.epv00(TAI_OF_1970_JD, (t + 32.184) / DAY_S)
    sun_velocity = [AU_KM / DAY_S * (b - h) for b, h in zip(barycentric['v'], heliocentric['v'])]
    now = [-AU_KM * h - p for h, p in zip(heliocentric['p'], position)]
    light_s = math.hypot(*now) / LIGHT_KM_S
    then = [n - light_s * v for n, v in zip(now, sun_velocity)]
    velocity_c = [AU_KM / DAY_S * v / LIGHT_KM_S for v in barycentric['v']]
    lorentz = math.sqrt(1.0 - sum(v * v for v in velocity_c))
    length = math.hypot(*then)
    return erfa.ab([x / length for x in then], velocity_c, length / AU_KM, lorentz)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def wrapped(angle):
    return math.remainder(angle, math.tau)


class Body:
    def __init__(self, mission, states, axis):
        self.spin, self.states, self.axis = mission['spin'], states, axis
        side = cross(axis, [0.0, 0.0, 1.0])
        self.x = [s / math.hypot(*side) for s in side]
        self.y = cross(axis, self.x)

    def seen(self, direction):
        """Azimuth in the frame across the axis, and the angle from the axis."""
        return (math.atan2(dot(direction, self.y), dot(direction, self.x)),
                math.acos(dot(direction, self.axis) / math.hypot(*direction)))

    def phase(self, channel, t):
        """Azimuth of slit 1 when the channel gives an edge at `t`."""
        position = state_at(self.states, t)
        if channel.startswith('sun'):
            azimuth, angle = self.seen(sun_from(position, t))
            if channel == 'sun1':
                return azimuth
            slit = self.spin['sun_sensor']
            lag = math.asin(math.tan(math.radians(slit['slit_cant_deg'])) / math.tan(angle))
            return azimuth + math.radians(slit['slit_separation_deg']) + lag
        beam = self.spin['ir'][channel.split('_')[0]]
        azimuth, angle = self.seen([-p for p in position])
        disc = math.asin((EARTH_KM + self.spin['horizon']['co2_altitude_km']) / math.hypot(*position))
        mount = math.radians(beam['mount_angle_deg'])
        half = math.acos((math.cos(disc) - math.cos(mount) * math.cos(angle)) / (math.sin(mount) * math.sin(angle)))
        return azimuth + (-half if channel.endswith('_in') else half) + math.radians(beam['azimuth_deg'])


def main(archive, mission_path):
    mission = tomllib.loads(pathlib.Path(mission_path).read_text())
    assert mission['spin']['horizon']['model'] == 'sphere'
    states = read_orbit(pathlib.Path(mission_path).parent / mission['orbit']['oem'])
    db = sqlite3.connect(archive)
    assert not db.execute("SELECT count(*) FROM spin_bias WHERE estimator = 'batch' AND estimated = 1").fetchone()[0]
    ra, dec, rpm = db.execute("SELECT ra_deg, dec_deg, spin_rate_rpm FROM pass_answer WHERE estimator = 'batch'").fetchone()
    drift_rpm_h, = db.execute('SELECT rate_drift_rpm_h FROM spin_batch ORDER BY t_tai_ns DESC LIMIT 1').fetchone()
    edges = db.execute("SELECT t_tai_ns, channel, residual_s FROM edge_residual WHERE estimator = 'batch' AND"
                       " residual_s IS NOT NULL ORDER BY t_tai_ns").fetchall()
    ra, dec = math.radians(ra), math.radians(dec)
    body = Body(mission, states, [math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])
    first_ns, last_ns = db.execute('SELECT min(t_tai_ns), max(t_tai_ns) FROM batch_residual').fetchone()
    half = 0.5e-9 * (last_ns - first_ns)
    drift = drift_rpm_h * math.tau / 60.0 / 3600.0
    rate = rpm * math.tau / 60.0 - drift * half
    differences = []
    for t_ns, channel, residual_s in edges:
        since = 1e-9 * (t_ns - first_ns) - half
        turned = (rate + 0.5 * drift * since) * since
        differences.append(wrapped(turned - body.phase(channel, 1e-9 * t_ns) - residual_s * (rate + drift * since)))
    common = math.atan2(sum(map(math.sin, differences)), sum(map(math.cos, differences)))
    print(max(abs(wrapped(one - common)) for one in differences) / rate)


main(*sys.argv[1:])
