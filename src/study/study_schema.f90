!> What a study file can say, in the terms of the schema of cases.
module study_schema
  use case_schema, only: key_t, group_definition_t, real_kind, integer_kind, logical_kind, word_kind, text_kind
  implicit none
  private
  public :: study_groups, study_keys

contains

  pure function study_groups() result(groups)
    type(group_definition_t) :: groups(2)
    groups = [ &
      group_definition_t(name='study', is_model=.true., &
                         description='a base case run many times; its case must be correct by itself'), &
      group_definition_t(name='parameter', is_model=.true., &
                         description='one key that is varied; the group stands here once for each')]
  end function study_groups

  pure function study_keys() result(keys)
    type(key_t), allocatable :: keys(:)
    character(len=*), parameter :: s = 'study', p = 'parameter'
    allocate (keys(20))
    keys(1) = key_t(s, 'title', text_kind, description='what the study is')
    keys(2) = key_t(s, 'case', text_kind, required=.true., example='sim_I.nml', &
                    description='base case; its path begins at this file')
    keys(3) = key_t(s, 'table', text_kind, &
                    description='CSV, a column for each key, a row for each run, instead of &parameter; path as case')
    keys(4) = key_t(s, 'design', word_kind, default='grid', words='grid, latin_hypercube, sobol', &
                    description='how the runs fill the ranges; a grid''s last parameter goes fastest')
    keys(5) = key_t(s, 'runs', integer_kind, default='0', range='> 0 and <= 10000000', description='of a sampled design')
    keys(6) = key_t(s, 'seed', integer_kind, default='0', range='>= 0', &
                    description='of a sampled design; sobol: 0 gives the points as they are, others shift them')
    keys(7) = key_t(s, 'settle_cycles', integer_kind, default='0', range='>= 0', &
                    description='crank revolutions at the start that the statistics leave out')
    keys(8) = key_t(s, 'traces', word_kind, default='none', words='none, all, failed', &
                    description='runs whose trace is written, as NAME/RUN.csv')
    keys(9) = key_t(s, 'cycles', logical_kind, default='.false.', &
                    description='write the statistics of each revolution too, as NAME.cycles.csv')
    keys(10) = key_t(s, 'strobe_angle_deg', real_kind, default='0.0', unit='degrees', &
                     description='crank angle at which the strobe columns are taken, once in a revolution')
    keys(11) = key_t(s, 'strobe_columns', text_kind, count=1000, description='columns for NAME.strobe.csv; empty: none')
    keys(12) = key_t(s, 'strobe_cycles', integer_kind, default='0', range='>= 0', &
                     description='strobes of a run, from settle_cycles on; 0: to its end')
    keys(13) = key_t(p, 'key', text_kind, required=.true., example='joint.clearance', description='GROUP.KEY of the base case')
    keys(14) = key_t(p, 'from', real_kind, default='0.0', example='1.0e-5', description='first value of the range')
    keys(15) = key_t(p, 'to', real_kind, default='0.0', example='5.0e-5', description='last value')
    keys(16) = key_t(p, 'count', integer_kind, default='0', example='5', range='>= 2 and <= 10000000', &
                     description='of values on a grid')
    keys(17) = key_t(p, 'scale', word_kind, default='linear', words='linear, log', description='values even in this scale')
    keys(18) = key_t(p, 'values', text_kind, count=1000, description='a list of values, with commas, instead of from, to, count')
    keys = keys(:18)
  end function study_keys
end module study_schema
