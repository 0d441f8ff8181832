!> The command line: every option in every form, and what is refused.
module test_command_line
  use error_handling, only: error_t, status_command_line
  use command_line, only: command_line_t, parse_command_line, help_text
  use accuracy_presets, only: with_preset
  use case_definition, only: case_t
  use case_file, only: read_case
  use portuguese, only: in_language
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_command_line

  character(len=*), parameter :: hint = '; gudgeon --help lists the options'
  character(len=*), parameter :: groups = ': case, mechanism, bearing_load, drive, initial, pin, joint, contact, friction, '// &
    'lubrication, asperities, wear, film_history, supply, bore, shape, heat, guide, ring, elastic_rod, crankshaft, damper, '// &
    'cylinder, combustion, cylinder_pressure, working_gas, valve, wall_heat, run, integrator, output'

contains

  subroutine run_test_command_line(check)
    class(checks_t), intent(inout) :: check
    call test_options(check)
    call test_refusals(check)
    call test_presets(check)
    call test_portuguese(check)
  end subroutine run_test_command_line

  !> An accuracy level sets method, contact entry and tolerance of any case; higher levels have smaller tolerances; --set takes
  !> precedence; without a level nothing changes.
  subroutine test_presets(check)
    class(checks_t), intent(inout) :: check
    type(case_t) :: case
    character(len=1) :: none(0)
    case = with_level('draft', none)
    call check%equal_text(trim(case%integrator%method), 'auto', 'draft: the method')
    call check%that(case%integrator%relative_tolerance > 9e-5, 'draft: the tolerance')
    call check%that(abs(case%run%periodic_tolerance - 1e-3) < 1e-9, 'draft: the tolerance of periods')
    case = with_level('draft', ['run.periodic_tolerance=1e-2'])
    call check%that(abs(case%run%periodic_tolerance - 1e-2) < 1e-9, 'draft: --set takes precedence over the tolerance of periods')
    case = with_level('standard', ['integrator.method=radau'])
    call check%equal_text(trim(case%integrator%method), 'radau', 'standard: --set takes precedence')
    call check%that(abs(case%integrator%relative_tolerance - 1e-6) < 1e-9, 'standard: the tolerance')
    case = with_level('reference', ['integrator.max_order=9'])
    call check%that(case%integrator%relative_tolerance < 2e-10 .and. case%integrator%max_order == 9, 'reference')
    call check%that(abs(case%run%periodic_tolerance - 1e-4) < 1e-9, 'reference: the tolerance of periods of the case')
    call check%equal_text(trim(case%integrator%contact_entry), 'root', 'reference: contact entry')
    case = with_level('', none)
    call check%equal_text(trim(case%integrator%method), 'auto', 'no level: the method of the case')
    case = with_level('dissertation', none)
    call check%equal_text(trim(case%integrator%method), 'adams', 'dissertation: the method')
    call check%equal_text(trim(case%integrator%contact_entry), 'step_rejection', 'dissertation: contact entry')

  contains

    function with_level(level, more) result(case)
      character(len=*), intent(in) :: level
      character(len=*), intent(in) :: more(:)
      type(case_t) :: case
      type(error_t), allocatable :: error
      call read_case('cases/flores/dry_0500um.nml', with_preset(level, more), case, error)
      call check%that(.not. allocated(error), 'level '//level//' is read')
    end function with_level
  end subroutine test_presets

  !> Portuguese of outcomes: the longest text counts, a star stands for a word, numbers have commas, labels are in columns; names of
  !> the user, of models and of keys stay, and so do unknown words.
  subroutine test_portuguese(check)
    class(checks_t), intent(inout) :: check
    character(len=1), parameter :: n = achar(10)
    call same('done: done; 2.5 revolutions in 1 s', 'done', 'done: concluída; 2,5 rotações em 1 s', 'a case named as a word')
    call same('a: done'//n//'  my run/rows of.csv; 1 steps', 'a'//n//'my run/rows of', &
      'a: concluída'//n//'  my run/rows of.csv; 1 passos', 'a path of words')
    call same('a.nml: correct'//n//'  main bearing short_bearing film'//n//'  rings       3, oil 4.5 mPa s', 'a.nml'//n//'rings', &
      'a.nml: correto'//n//'  mancal principal filme short_bearing'//n//'  anéis            3, óleo 4,5 mPa s', &
      'labels and a star')
    call same('x; film of at least 1e-3 m (2.5 m in the last cycle) film_2.5/b', '', &
      'x; filme de no mínimo 1e-3 m (2,5 m no último ciclo) film_2.5/b', 'brackets, and words that are no numbers')
    call same('running, contacts)', '', 'running, contatos)', 'the end of a word')
    call same('a: done'//n//'  note: done in 1.5 runs'//n//'  note: of', 'a', &
      'a: concluída'//n//'  aviso: done in 1.5 runs'//n//'  aviso: of', 'notes')
    call same('a.nml: correct'//n//'  film table  piston pin: stored in /my rows of 1.5/x; crank pin: must be '// &
      'computed, in about 1 s', 'a.nml', 'a.nml: correto'//n// &
      '  tabela do filme  pino do pistão: guardada em /my rows of 1.5/x; '// &
      'pino da manivela: deve ser calculada, em cerca de 1 s', 'paths of tables')
    call same('', '', '', 'nothing')
    call check%equal_text(in_language('a: done', 'en', ''), 'a: done', 'English')

  contains

    subroutine same(text, names, wanted, what)
      character(len=*), intent(in) :: text, names, wanted, what
      call check%equal_text(in_language(text, 'pt', names), wanted, 'Portuguese: '//what)
    end subroutine same
  end subroutine test_portuguese

  subroutine test_options(check)
    class(checks_t), intent(inout) :: check
    type(command_line_t) :: line
    type(error_t), allocatable :: error
    call parse_command_line(['a.nml'], line, error)
    call check%that(.not. allocated(error), 'one case')
    call check%equal_text(line%out, 'results', 'folder by default')
    call check%equal_text(line%progress, 'auto', 'progress by default')
    call check%equal_text(line%language, 'en', 'language by default')
    call check%equal_text(line%accuracy, '', 'accuracy by default')
    call check%that(line%jobs == 0 .and. size(line%overrides) == 0 .and. size(line%cases) == 1, 'nothing else by default')
    call parse_command_line([character(len=40) :: '-o', 'out dir', 'b/a.nml', '--set=joint.clearance=1e-5', '-s', &
                             'case.title=x', '-scase.title=y', '--accuracy', 'draft', '-j4', '--progress=never', '-q', &
                             '--check', '--', '-c.nml'], line, error)
    call check%that(.not. allocated(error), 'all options')
    call check%equal_text(line%out, 'out dir', '-o')
    call check%that(size(line%overrides) == 3, 'three overrides')
    call check%equal_text(trim(line%overrides(1)), 'joint.clearance=1e-5', '--set=')
    call check%equal_text(trim(line%overrides(2)), 'case.title=x', '-s')
    call check%equal_text(trim(line%overrides(3)), 'case.title=y', '-sVALUE')
    call check%equal_text(line%accuracy, 'draft', '--accuracy')
    call check%equal_text(line%progress, 'never', '--progress=')
    call check%that(line%jobs == 4, '-jN')
    call check%that(line%quiet .and. line%check .and. .not. line%help, 'switches')
    call check%that(size(line%cases) == 2, 'two cases')
    call check%equal_text(trim(line%cases(2)), '-c.nml', 'a case after --')
    call parse_command_line([character(len=16) :: 'sweep', '--language', 'pt', 's.nml'], line, error)
    call check%that(.not. allocated(error) .and. line%language == 'pt', '--language of a study')
    call parse_command_line(['-qh'], line, error)
    call check%that(.not. allocated(error) .and. line%help .and. line%quiet, 'switches in one')
    call parse_command_line(['-V'], line, error)
    call check%that(.not. allocated(error) .and. line%version, 'version needs no case')
    call parse_command_line(['--template'], line, error)
    call check%that(.not. allocated(error) .and. line%template .and. line%kind == '', 'template needs no case')
    call parse_command_line(['--template=film'], line, error)
    call check%that(.not. allocated(error) .and. line%template .and. line%kind == 'film', 'a kind of template')
    call parse_command_line(['--reference=joint'], line, error)
    call check%that(.not. allocated(error) .and. line%reference == 'joint', 'reference of a group')
    call parse_command_line(['--name', 'soft  ', '-     '], line, error)
    call check%that(.not. allocated(error) .and. line%name == 'soft', 'name of the results')
    call check%that(size(line%cases) == 1 .and. trim(line%cases(1)) == '/dev/stdin', '- is standard input')
    call check%that(index(help_text(), '--accuracy LEVEL') > 0, 'help lists options')
    call parse_command_line([character(len=16) :: '-s', 'lubrication=none', 'a.nml'], line, error)
    call check%that(.not. allocated(error) .and. size(line%overrides) == 1, 'a removed group')
    call parse_command_line([character(len=16) :: '-q', 'sweep', '-o', 'r', 's.nml'], line, error)
    call check%that(.not. allocated(error) .and. line%sweep .and. size(line%cases) == 1, 'sweep after an option')
    call parse_command_line([character(len=16) :: 'sweep', 'sweep'], line, error)
    call check%that(.not. allocated(error) .and. line%sweep .and. size(line%cases) == 1, 'a study named sweep')
    call parse_command_line([character(len=16) :: '--', 'sweep'], line, error)
    call check%that(.not. (allocated(error) .or. line%sweep) .and. size(line%cases) == 1, 'a case named sweep')
  end subroutine test_options

  subroutine test_refusals(check)
    class(checks_t), intent(inout) :: check
    character(len=1) :: none(0)
    character(len=*), parameter :: stands_alone = &
      '--template, --reference, --completion and --man are not combined with other options or with files'//hint
    call refused(check, none, 'no case file given'//hint)
    call refused(check, [character(len=16) :: '--template', '-s', 'drive=none'], stands_alone)
    call refused(check, [character(len=16) :: '-q', 'sweep', '--template'], stands_alone)
    call refused(check, [character(len=16) :: '--template', 'a.nml'], stands_alone)
    call refused(check, [character(len=16) :: '--reference', 'case', '-o', 'r'], stands_alone)
    call refused(check, ['--chekc'], '--chekc: unknown option; did you mean --check?'//hint)
    call refused(check, ['--xyzzy'], '--xyzzy: unknown option'//hint)
    call refused(check, ['-x'], '-x: unknown option'//hint)
    call refused(check, [''], 'an empty argument is no case file'//hint)
    call refused(check, ['--out'], '--out: must name a folder'//hint)
    call refused(check, ['--template=dryy'], '--template dryy: must be one of dry, film, engine, compressor, slap, '// &
      'elastic, wear; did you mean dry?'//hint)
    call refused(check, ['--template='], '--template: must be one of dry, film, engine, compressor, slap, elastic, '// &
      'wear'//hint)
    call refused(check, [character(len=16) :: 'sweep', '--template=dry'], 'gudgeon sweep --template has no kinds'//hint)
    call refused(check, ['--reference=joints'], &
      '--reference joints: must be case, study, oils, results, schema or a group of cases'//groups// &
      '; did you mean joint?'//hint)
    call refused(check, ['--reference'], &
      '--reference: must be case, study, oils, results, schema or a group of cases'//groups//hint)
    call refused(check, [character(len=16) :: '--template', 'engine'], &
      '--template engine: a kind stands behind =: --template=KIND, one of dry, film, engine, compressor, slap, elastic, wear'//hint)
    call refused(check, ['--reference=injector'], &
      '--reference injector: must be case, study, oils, results, schema or a group of cases'//groups//hint)
    call refused(check, ['--name=a/b'], '--name a/b: must be a name without folder; --out gives the folder'//hint)
    call refused(check, [character(len=16) :: '--name=a', 'b.nml', 'c.nml'], '--name is for one case'//hint)
    call refused(check, [character(len=16) :: 'sweep', '--name=a', 'b.nml'], '--name is for one case'//hint)
    call refused(check, ['-o'], '--out: must name a folder'//hint)
    call refused(check, ['--out='], '--out: must name a folder'//hint)
    call refused(check, ['--quiet=1'], '--quiet: takes no value'//hint)
    call refused(check, ['-sclearance=1'], '--set clearance=1: must have the form GROUP.KEY=VALUE or GROUP=none'//hint)
    call refused(check, ['-sjoint.clearance'], '--set joint.clearance: must have the form GROUP.KEY=VALUE or GROUP=none'// &
                 hint)
    call refused(check, ['-slubrication=off'], '--set lubrication=off: must have the form GROUP.KEY=VALUE or GROUP=none'//hint)
    call refused(check, ['-s=none'], '--set =none: must have the form GROUP.KEY=VALUE or GROUP=none'//hint)
    call refused(check, ['-abest'], '--accuracy best: must be one of draft, standard, reference, dissertation'//hint)
    call refused(check, ['--completion'], '--completion: must be bash, zsh or fish'//hint)
    call refused(check, [character(len=16) :: '--language', 'pt', 'plot', 'report'], &
      'plot stands before all options: gudgeon plot WHAT [RUN ...]'//hint)
    call refused(check, ['--language=de'], '--language de: must be en or pt'//hint)
    call refused(check, ['--progress=on'], '--progress on: must be auto, always or never'//hint)
    call refused(check, ['-j0'], '--jobs 0: must be a whole number from 1 to 1024'//hint)
    call refused(check, ['-j-1'], '--jobs -1: must be a whole number from 1 to 1024'//hint)
    call refused(check, ['-j4 ', '-jx '], '--jobs x: must be a whole number from 1 to 1024'//hint)
    call refused(check, ['a/x.nml', 'b/x.nml'], &
                 'a/x.nml and b/x.nml: their results would have the same names; run them separately with --out')
    call refused(check, [character(len=12) :: 'x.nml', 'x.ideal.nml'], &
                 'x.ideal.nml: x has results whose names begin with x.ideal: give another name with --name')
    call refused(check, [character(len=14) :: '--name', 'a.film_history', 'x.nml'], &
                 'x.nml: a has results whose names begin with a.film_history: give another name with --name')
    call refused(check, ['c/x.runs.nml'], &
                 'c/x.runs.nml: x has results whose names begin with x.runs: give another name with --name')
    call refused(check, [character(len=14) :: 'sweep', 'x.chunks.nml'], &
                 'x.chunks.nml: x has results whose names begin with x.chunks: give another name')
    call refused(check, ['--name=-x', 'x.nml    '], '--name -x: must not begin with -'//hint)
    call refused(check, ['--name=a'//achar(10)//'b', 'x.nml     '], &
                 '--name a\x0Ab: must not contain control characters or bytes that are not UTF-8'//hint)
    call refused(check, ['--'//achar(27)//achar(10)], '--\x1B\x0A: unknown option'//hint)
  end subroutine test_refusals

  subroutine refused(check, arguments, message)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: arguments(:), message
    type(command_line_t) :: line
    type(error_t), allocatable :: error
    call parse_command_line(arguments, line, error)
    call check%that(allocated(error), 'refused: '//message)
    if (.not. allocated(error)) return
    call check%equal_text(error%message, message, 'message')
    call check%that(error%status == status_command_line, 'status of '//message)
  end subroutine refused
end module test_command_line
