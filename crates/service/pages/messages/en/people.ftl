## Sign-in and account

sign-in-heading = Sign in
sign-in-password = Password
sign-in-with = Sign in with { $provider }
sign-in-hint = You get a user name and password from an admin, who can also reset the password. Programs use a service key.
account-roles = Your roles
account-no-roles = None yet: an admin grants roles.
account-old-password = Present password
account-new-password = New password, at least 15 characters
account-change-password = Change password
account-provider = Sign-in by a provider
account-no-provider = No provider is linked with this account yet.
account-link = Link with { $provider }
account-session = Session
account-sign-out = Sign out
account-local = You have no account here: you have access from this machine or by a key.
account-password-changed = The password is changed; sign in again on your other devices.
account-linked = Your account is linked.
leave-heading = Link your account
leave-explained = Sign in at { $provider }. Your account there is then linked with this account, so that you can sign in here with it.
leave-continue = Continue to { $provider }
leave-cancel = Cancel

## Users

users-on-this-page = On this page: users, <a href="#keys">service keys</a> of programs, <a href="#approval">approval</a>. Messages to chat rooms and programs: <a href="/webhooks">webhooks</a>.
users-roles-explained = A reader looks, an engineer also uploads and refines, an approver also puts versions into use, an admin also manages people. Each role has the rights of those before it, on the whole server or on one ship or family.
users-user-name = User name
users-roles = Roles
users-since = Since
users-state = State
users-linked-with = linked with { $issuer }:
users-change = change
users-save-roles = Save the roles
users-new-password-of = New password of { $name }
users-set = set
users-enabled = enabled
users-disabled = disabled
users-disable = disable
users-enable = enable
users-further = Further users
users-new = New user
users-new-name = User name (cannot be changed later)
users-new-title = Name of the person
users-new-initial = Initial password, at least 15 characters
users-create = Create

## Service keys

keys-heading = Service keys
keys-explained = For programs. A key is shown only once; the server keeps its prefix and hash.
keys-key = Key
keys-purpose = Purpose
keys-on-behalf = On behalf of
keys-expires = Expires
keys-last-used = Last used
keys-revoke = Revoke
keys-revoke-button = revoke
keys-revoke-one = Revoke { $key }
keys-revoked = revoked { $at }
keys-until-revoked = when revoked
keys-never-used = never
keys-further = Further keys
keys-new = New key
keys-new-user = On behalf of user (optional)
keys-new-days = Expires after days (optional)
keys-create = Create key
keys-new-heading = New key: { $title }
keys-copy-now = Copy it now: it is not shown again.
keys-usage = A program sends it as <code>Authorization: Bearer KEY</code>.
keys-back = Users and keys

## Approval

approval-heading = Approval by a second person
approval-on = A version becomes champion only with the approval of a user who did not create it.
approval-off = An engineer may promote a version of their own to champion.
approval-turn-off = Do not require approval
approval-turn-on = Require approval

## Webhooks

webhooks-heading = Webhooks
webhooks-explained = Messages to a mail box, a chat room or a program when a ship's model changes or is in doubt. Channels of Slack and Microsoft Teams, recognised by their address, and mail boxes get a sentence with a link; other receivers get JSON with a signature.
webhooks-format = Format
webhooks-sent-when = Sent when
webhooks-last = Last message
webhooks-end = end
webhooks-end-one = End { $title }
webhooks-ended = ended
webhooks-all-ships = all ships
webhooks-none-sent = none yet
webhooks-arrived = arrived { $at }
webhooks-not-arrived = not arrived: { $why }
webhooks-not-sent = not sent yet
webhooks-event-champion = another version is in use
webhooks-event-diagnosis = a diagnosis finds that the model does not hold
webhooks-event-drift = the model drifts
webhooks-event-other = another event
webhooks-new = New webhook
webhooks-purpose-hint = For example channel of the fleet
webhooks-address = Address
webhooks-send-when = Send a message when
webhooks-ship = Ship (optional)
webhooks-ship-hint = Short name; by default all ships
webhooks-drift = Drift above (optional)
webhooks-drift-hint = Unexplained force on new trials divided by that on the fitted ones; by default 2
webhooks-create = Create the webhook
webhooks-links = Links in messages
webhooks-server = Address of this server
webhooks-server-hint = As people open it in the browser, for example https://ships.example.com; without it messages have no link
webhooks-save = Save
webhooks-new-heading = New webhook: { $title }
webhooks-secret = A program that checks the signature needs this secret. Copy it now: it is not shown again. A chat room needs none.
webhooks-signature = Every delivery has the header <code>Sistership-Signature: t=SECONDS,v1=HEX</code>, the HMAC-SHA256 of <code>SECONDS.BODY</code> under the secret.

## Refusals

sign-in-other-site = sign in on the page of this server; the request comes from another web site
account-wrong-password = is not your present password
account-sign-in-first = sign in first; a key or this machine has no password
account-sign-in-to-link = sign in first, so that there is an account to link
webhooks-mail-hint = As Slack, Teams or the program gives it, beginning with https://; or mailto: and a mail box, for example mailto:master@example.com
webhooks-no-mail-hint = As Slack, Teams or the program gives it, beginning with https://. Mail needs a server that sends it: SISTERSHIP_SMTP_URL and --mail-from
