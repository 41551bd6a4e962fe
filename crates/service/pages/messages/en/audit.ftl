audit-explained = All changes with their authors, the latest first. Entries cannot be changed; each contains the hash of the previous one, and <code>sistership fsck</code> checks all of them. <a href="/v1/audit">As JSON</a>
audit-by = By
audit-about-hint = About, as ship:NAME
audit-number = Number
audit-when = When
audit-who = Who
audit-what = What
audit-about = About
audit-from = From
audit-details = Details
audit-show = show
audit-before = Before:
audit-after = After:
audit-earlier = Earlier entries
audit-only-one = give only one of the two

## Sentences

audit-of-subject = { $verb } the { $noun } { $name }
audit-of-other = { $verb } the { $noun } of { $kind } { $name }
audit-unknown-verb = { $verb } of the { $noun }, { $kind } { $name }
audit-name-of-ship = { $own } of { $ship }
audit-of-ship = of { $ship }
audit-verb-create = created
audit-verb-update = changed
audit-verb-delete = deleted
audit-verb-undelete = restored
audit-verb-move = moved
audit-verb-tag = tagged
audit-verb-untag = removed a tag from
audit-verb-note = added a note to
audit-verb-cancel = cancelled
audit-verb-retry = repeated
audit-verb-enable = enabled
audit-verb-disable = disabled
audit-verb-revoke = revoked
audit-verb-begin = began
audit-verb-end = ended
audit-verb-add = added a member to
audit-verb-set = set
audit-verb-save = saved
audit-verb-sign = signed
audit-verb-conditions = stated the conditions of

## Kinds of subjects

audit-noun-ship = ship
audit-noun-version = version
audit-noun-alias = alias
audit-noun-trial = trial
audit-noun-job = job
audit-noun-family = family
audit-noun-user = user
audit-noun-key = key
audit-noun-session = session
audit-noun-webhook = webhook
audit-noun-template = template
audit-noun-setting = setting
audit-noun-law = law
audit-noun-report = report
audit-noun-diagnosis = diagnosis
audit-noun-roles = roles
audit-noun-settings = settings

## Kinds of subjects by themselves

audit-subject-ship = ship
audit-subject-version = version
audit-subject-trial = trial
audit-subject-job = job
audit-subject-family = family
audit-subject-user = user
audit-subject-key = key
audit-subject-webhook = webhook
audit-subject-law = law
audit-subject-diagnosis = diagnosis
audit-subject-session = session
audit-subject-template = template
audit-subject-settings = settings
