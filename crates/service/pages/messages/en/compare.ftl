compare-heading = Compare versions
compare-explained = Two to five versions: write a ship for the version in use, or ship/number. The address of this page contains the selection and can be shared.
compare-version-number = Version { $number }
compare-button = Compare
compare-begin = Names are offered while you type. You can also mark ships in the <a href="/">list of your fleet</a> or in the <a href="/?ships=library">library</a>, or versions on the page of a ship. For example: <a href="/compare?v=mariner&amp;v=kcs">Mariner and KCS</a>.
compare-speed = Approach speed
compare-turns = Turning circles of 35 deg to starboard
compare-turns-label = turning circles, 35 deg to starboard
compare-zigzags = Zigzags 20/20
compare-zigzags-label = zigzags 20/20
compare-criteria = Criteria of IMO MSC.137(76)
compare-standard = Standard manoeuvres
compare-standard-explained = Simulated in calm, deep water, each version from its own approach speed. Differences refer to the first version.
compare-coefficients-explained = Coefficients of the same name are comparable only if the laws are the same.
compare-pass-limit = { $verdict }, limit { $limit }
compare-too-many = at most { $most } versions can be compared
compare-not-simulated = { $version } cannot be simulated: { $reason }
